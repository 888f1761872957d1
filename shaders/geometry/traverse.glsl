// Closest hit and occlusion: the nearest surface that a ray meets, found in the scene's BVH or by the device.
#ifndef ISOPHOTE_GEOMETRY_TRAVERSE_GLSL
#define ISOPHOTE_GEOMETRY_TRAVERSE_GLSL

#include "geometry/alpha_test.glsl"

struct RayHit {
  float t;           // in units of the direction's length
  uint instance;     // index into the InstanceRecord array
  uint triangle;     // index into the BvhTriangle array; kInvalidIndex: a sphere light
  vec2 barycentrics; // weights of v1 and v2
  bool found;
  bool stackOverflow; // never, while the builder keeps to kMaxBvhDepth
};

// The kernels of either backend are compiled from the same files.
#ifdef ISOPHOTE_RAY_QUERY
#include "geometry/traverse_ray_query.glsl"
#else
#include "geometry/traverse_bvh.glsl"
#endif

/// The closest surface with tMin <= t < tMax that the alpha test accepts.
///
/// @param direction  any length; t counts in units of it, in every instance
/// @param tMin       >= 0
/// @param tMax       kRayInfinity where nothing bounds the ray
/// @param ignored    instance of a sphere light that the ray does not see, or kInvalidIndex
RayHit traceClosest(const SceneRef scene, const vec3 origin, const vec3 direction, const float tMin, const float tMax,
                    const AlphaKey key, const uint ignored) {
  return traverse(scene, origin, direction, tMin, tMax, key, ignored, false);
}

/// Whether any surface that the alpha test accepts has tMin <= t < tMax.
///
/// @param ignored  instance of the sphere light that the ray ends on, or kInvalidIndex
bool traceOccluded(const SceneRef scene, const vec3 origin, const vec3 direction, const float tMin, const float tMax,
                   const AlphaKey key, const uint ignored, out bool stackOverflow) {
  const RayHit hit = traverse(scene, origin, direction, tMin, tMax, key, ignored, true);
  stackOverflow = hit.stackOverflow;
  return hit.found;
}

#endif
