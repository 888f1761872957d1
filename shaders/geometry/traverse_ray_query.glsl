// The device's acceleration structures, asked by ray query. Included by geometry/traverse.glsl alone.
//
// The device finds candidates; what counts as a hit is decided here as in geometry/traverse_bvh.glsl, for two reasons.
// Rays leave surfaces by an offset that only intersectTriangle's bounds promise to suffice: how a device rounds is its
// own affair, and it may meet the triangle that the ray has just left. And the same triangle then gives the same bits.
#ifndef ISOPHOTE_GEOMETRY_TRAVERSE_RAY_QUERY_GLSL
#define ISOPHOTE_GEOMETRY_TRAVERSE_RAY_QUERY_GLSL

#extension GL_EXT_ray_query : require

#include "geometry/alpha_test.glsl"
#include "geometry/instance_map.glsl"
#include "geometry/ray_sphere.glsl"
#include "geometry/ray_triangle.glsl"

// Index into the BvhTriangle array.
uint triangleOf(const SceneRef scene, const uint customIndex, const uint geometry, const uint primitive) {
  return UintRef(scene.view.rangeStarts).items[customIndex + geometry] + primitive;
}

/// Whether a triangle that the device reports is there.
///
/// Where the project's test sees the ray beyond an edge it depends on whether the triangle's plane is certainly ahead:
/// a neighbor would be met there, which the device, having settled on this triangle, does not report.
/// @param hit  as the device has it; t and barycentrics become those of intersectTriangle where that finds the triangle
bool isHit(const SceneRef scene, const vec3 origin, const vec3 direction, const float tMin, const float tMax,
           inout RayHit hit) {
  const Affine objectFromWorld = objectFromWorldOf(InstanceRef(scene.view.instances), hit.instance);
  const TriangleRay ray =
      makeTriangleRay(transformPoint(objectFromWorld, origin), transformVector(objectFromWorld, direction));
  const BvhTriangle face = BvhTriangleRef(scene.view.triangles).items[hit.triangle];
  const TriangleHit own = intersectTriangle(ray, face.v0, face.v1, face.v2);
  if (own.found) {
    hit.t = own.t;
    hit.barycentrics = own.barycentrics;
  } else if (distanceAhead(ray, face.v0, face.v1, face.v2) == 0.0) {
    return false;
  }
  return hit.t >= tMin && hit.t < tMax;
}

bool passesAlphaTest(const SceneRef scene, const AlphaKey key, const RayHit hit) {
  const BvhTriangle face = BvhTriangleRef(scene.view.triangles).items[hit.triangle];
  return (face.flags & kTriangleHasAlpha) == 0u ||
         passesAlphaTest(scene, key, hit.instance, face.geometry, face.primitiveIndex, hit.barycentrics);
}

// Macros, because a query cannot be handed to a function. `committed` is a literal: the hit the device has settled on,
// or the candidate it asks about.
#define QUERY_TRIANGLE(query, committed)                                                                               \
  RayHit(rayQueryGetIntersectionTEXT(query, committed), rayQueryGetIntersectionInstanceIdEXT(query, committed),        \
         triangleOf(scene, rayQueryGetIntersectionInstanceCustomIndexEXT(query, committed),                            \
                    rayQueryGetIntersectionGeometryIndexEXT(query, committed),                                         \
                    rayQueryGetIntersectionPrimitiveIndexEXT(query, committed)),                                       \
         rayQueryGetIntersectionBarycentricsEXT(query, committed), true, false)

// Boxes of spheres are one instance after those of meshes.
#define QUERY_SPHERE(query, committed)                                                                                 \
  (rayQueryGetIntersectionInstanceIdEXT(query, committed) + rayQueryGetIntersectionPrimitiveIndexEXT(query, committed))

/// The body of traceClosest and traceOccluded, as in geometry/traverse_bvh.glsl.
///
/// The device decides about opaque triangles by itself, at its own speed. Where what it comes to is no hit (see isHit),
/// it is asked once more and every candidate is decided here.
RayHit traverse(const SceneRef scene, const vec3 origin, const vec3 direction, const float tMin, const float tMax,
                const AlphaKey key, const uint ignored, const bool anyHit) {
  const RayHit miss = RayHit(tMax, kInvalidIndex, kInvalidIndex, vec2(0.0), false, false);
  if (scene.view.instanceCount == 0u) return miss;
  uint flags = anyHit ? gl_RayFlagsTerminateOnFirstHitEXT : gl_RayFlagsNoneEXT;
  for (uint attempt = 0u; attempt < 2u; ++attempt) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(scene.view.topLevel), flags, 0xffu, origin, tMin, direction,
                          tMax);
    while (rayQueryProceedEXT(query)) {
      if (rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionTriangleEXT) {
        RayHit hit = QUERY_TRIANGLE(query, false);
        if (isHit(scene, origin, direction, tMin, tMax, hit) && (!kHasAlpha || passesAlphaTest(scene, key, hit)))
          rayQueryConfirmIntersectionEXT(query);
      } else if (kHasSphereLights) {
        const uint index = QUERY_SPHERE(query, false);
        const vec4 sphere = InstanceRef(scene.view.instances).items[index].worldFromObject[0];
        const SphereHit hit = intersectSphere(origin, direction, sphere.xyz, sphere.w, tMin);
        float nearest = tMax;
        if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT)
          nearest = rayQueryGetIntersectionTEXT(query, true);
        if (hit.found && index != ignored && hit.t < nearest) rayQueryGenerateIntersectionEXT(query, hit.t);
      }
    }
    const uint type = rayQueryGetIntersectionTypeEXT(query, true);
    if (type == gl_RayQueryCommittedIntersectionNoneEXT) return miss;
    if (kHasSphereLights && type == gl_RayQueryCommittedIntersectionGeneratedEXT)
      return RayHit(rayQueryGetIntersectionTEXT(query, true), QUERY_SPHERE(query, true), kInvalidIndex, vec2(0.0), true,
                    false);
    RayHit hit = QUERY_TRIANGLE(query, true);
    if (isHit(scene, origin, direction, tMin, tMax, hit)) return hit;
    flags |= gl_RayFlagsNoOpaqueEXT;
  }
  return miss;
}

#endif
