// Per-vertex attributes at a point of a triangle, each behind the feature that brings it.
#ifndef ISOPHOTE_GEOMETRY_ATTRIBUTES_GLSL
#define ISOPHOTE_GEOMETRY_ATTRIBUTES_GLSL

#include "shared/buffers.glsl"
#include "shared/constants.glsl"

/// Attribute elements of a triangle's corners, relative to its geometry's first element.
uvec3 triangleCorners(const SceneRef scene, const Geometry geometry, const uint primitiveIndex) {
  UintRef indices = UintRef(scene.view.indices);
  const uint first = geometry.firstIndex + 3u * primitiveIndex;
  return uvec3(indices.items[first], indices.items[first + 1u], indices.items[first + 2u]);
}

/// Texture coordinates of set `uvSet`; (0, 0) where the geometry has none.
vec2 interpolateUv(const SceneRef scene, const Geometry geometry, const uint primitiveIndex, const vec2 barycentrics,
                   const uint uvSet) {
  const uint first = uvSet == 0u   ? geometry.firstUv[0]
                     : uvSet == 1u ? geometry.firstUv[1]
                     : uvSet == 2u ? geometry.firstUv[2]
                                   : geometry.firstUv[3];
  if (first == kInvalidIndex) return vec2(0.0);
  Vec2Ref uvs = Vec2Ref(scene.view.uvs);
  const uvec3 corner = triangleCorners(scene, geometry, primitiveIndex) + first;
  const vec2 uv0 = uvs.items[corner.x];
  return uv0 + barycentrics.x * (uvs.items[corner.y] - uv0) + barycentrics.y * (uvs.items[corner.z] - uv0);
}

/// Linear vertex color; white where the geometry has none.
vec4 interpolateColor(const SceneRef scene, const Geometry geometry, const uint primitiveIndex,
                      const vec2 barycentrics) {
  if (!kHasVertexColors || geometry.firstColor == kInvalidIndex) return vec4(1.0);
  Vec4Ref colors = Vec4Ref(scene.view.colors);
  const uvec3 corner = triangleCorners(scene, geometry, primitiveIndex) + geometry.firstColor;
  const vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
  return weights.x * colors.items[corner.x] + weights.y * colors.items[corner.y] + weights.z * colors.items[corner.z];
}

/// Shading normal in object space, not normalized; zero where the geometry has none.
vec3 interpolateNormal(const SceneRef scene, const Geometry geometry, const uint primitiveIndex,
                       const vec2 barycentrics) {
  if (!kHasShadingNormals || geometry.firstNormal == kInvalidIndex) return vec3(0.0);
  Vec3Ref normals = Vec3Ref(scene.view.normals);
  const uvec3 corner = triangleCorners(scene, geometry, primitiveIndex) + geometry.firstNormal;
  const vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
  return weights.x * normals.items[corner.x] + weights.y * normals.items[corner.y] +
         weights.z * normals.items[corner.z];
}

/// Tangent in object space, not normalized, w = +-1 of the first corner; zero where the geometry has none.
vec4 interpolateTangent(const SceneRef scene, const Geometry geometry, const uint primitiveIndex,
                        const vec2 barycentrics) {
  if (!(kHasNormalMaps || kHasAnisotropy) || geometry.firstTangent == kInvalidIndex) return vec4(0.0);
  Vec4Ref tangents = Vec4Ref(scene.view.tangents);
  const uvec3 corner = triangleCorners(scene, geometry, primitiveIndex) + geometry.firstTangent;
  const vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
  const vec4 first = tangents.items[corner.x];
  return vec4(weights.x * first.xyz + weights.y * tangents.items[corner.y].xyz +
                  weights.z * tangents.items[corner.z].xyz,
              first.w);
}

#endif
