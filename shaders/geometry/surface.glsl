// The surface at a hit: position with its error, normals, tangent, and where its material and attributes are.
#ifndef ISOPHOTE_GEOMETRY_SURFACE_GLSL
#define ISOPHOTE_GEOMETRY_SURFACE_GLSL

#include "geometry/attributes.glsl"
#include "geometry/instance_map.glsl"
#include "geometry/ray_offset.glsl"
#include "geometry/triangle_normal.glsl"
#include "math/normalize.glsl"

struct SurfaceHit {
  vec3 p;       // world, relative to the scene's origin
  vec3 pError;  // half extents of the box that holds the exact point
  vec3 ng;      // unit geometric normal
  vec3 ns;      // unit interpolated normal on ng's side; ng where there is none
  vec4 tangent; // of the vertices, world, not normalized or orthogonal; w = +-1 so that bitangent = w cross(ns, xyz);
                // xyz = 0 where there is none
  vec2 barycentrics; // weights of v1 and v2
  uint material;
  uint geometry;
  uint primitiveIndex;
  uint instance;
  uint triangle;  // index into the BvhTriangle array
  uint flags;     // kTriangleHasAlpha, kTriangleEmissive
  float area;     // of the triangle in world space
  bool frontFace; // ng is the front's: counter-clockwise as seen in object space
};

// Area in world space.
float worldArea(const Affine worldFromObject, const vec3 e01, const vec3 e12, const vec3 e20) {
  const EdgeCross edges = crossEdges(transformVector(worldFromObject, e01), transformVector(worldFromObject, e12),
                                     transformVector(worldFromObject, e20));
  return 0.5 * length(edges.value) / edges.scale / edges.scale;
}

/// The surface at barycentric weights (b1, b2) of a triangle, with ng and ns on its front.
///
/// The front of a face is where its vertices run counter-clockwise in object space; a mirroring map takes that side
/// along (glTF 2.0, section 3.7.4). The inverse transpose does the same to normals, so only the tangent's sign needs
/// the flag.
SurfaceHit surfaceAt(const SceneRef scene, const uint instance, const uint triangle, const vec2 barycentrics) {
  const BvhTriangle face = BvhTriangleRef(scene.view.triangles).items[triangle];
  InstanceRef instances = InstanceRef(scene.view.instances);
  const Affine worldFromObject = worldFromObjectOf(instances, instance);
  const Affine objectFromWorld = objectFromWorldOf(instances, instance);
  const Geometry geometry = GeometryRef(scene.view.geometries).items[face.geometry];

  SurfaceHit surface;
  const HitPoint point =
      hitPointToWorld(pointOnTriangle(face.v0, face.v1, face.v2, barycentrics), worldFromObject, objectFromWorld);
  surface.p = point.p;
  surface.pError = point.pError;

  const vec3 e01 = face.v1 - face.v0;
  const vec3 e12 = face.v2 - face.v1;
  const vec3 e20 = face.v0 - face.v2;
  surface.ng = safeNormalize(transformByTranspose(objectFromWorld, crossEdges(e01, e12, e20).value), vec3(0, 0, 1));
  surface.area = worldArea(worldFromObject, e01, e12, e20);

  surface.ns = surface.ng;
  if (kHasShadingNormals) {
    const vec3 ns =
        transformByTranspose(objectFromWorld, interpolateNormal(scene, geometry, face.primitiveIndex, barycentrics));
    surface.ns = safeNormalize(ns, surface.ng);
    if (dot(surface.ns, surface.ng) < 0.0) surface.ns = -surface.ns;
  }
  surface.tangent = vec4(0.0, 0.0, 0.0, 1.0);
  if (kHasNormalMaps || kHasAnisotropy) {
    const vec4 tangent = interpolateTangent(scene, geometry, face.primitiveIndex, barycentrics);
    const bool mirrored = (instances.items[instance].flags & kInstanceMirrored) != 0u;
    surface.tangent = vec4(transformVector(worldFromObject, tangent.xyz), mirrored ? -tangent.w : tangent.w);
  }

  surface.barycentrics = barycentrics;
  surface.material = geometry.material;
  surface.geometry = face.geometry;
  surface.primitiveIndex = face.primitiveIndex;
  surface.instance = instance;
  surface.triangle = triangle;
  surface.flags = face.flags;
  surface.frontFace = true;
  return surface;
}

/// The same as seen from direction wo: ng and ns are turned to wo's side of the triangle.
SurfaceHit surfaceAt(const SceneRef scene, const uint instance, const uint triangle, const vec2 barycentrics,
                     const vec3 wo) {
  SurfaceHit surface = surfaceAt(scene, instance, triangle, barycentrics);
  surface.frontFace = dot(surface.ng, wo) >= 0.0;
  if (!surface.frontFace) {
    surface.ng = -surface.ng;
    surface.ns = -surface.ns;
  }
  return surface;
}

#endif
