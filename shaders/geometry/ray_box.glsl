// Rays against axis-aligned boxes: never misses a box whose content the triangle test would find.
#ifndef ISOPHOTE_GEOMETRY_RAY_BOX_GLSL
#define ISOPHOTE_GEOMETRY_RAY_BOX_GLSL

#include "geometry/float_steps.glsl"

// Direction components below 2^-60 count as 2^-60. The near distance of such a slab can only come out smaller than it
// is, and the far one gains more from the padding than the ray moves, up to t = 1e12 times the farthest corner's
// distance.
const float kSmallestSlabDirection = 8.6736174e-19; // 2^-60
const float kLargestSlabInverse = 1.1529215e18;     // 2^60

// Boxes are padded by this times the distance of the farthest corner of the tree. Woop, Benthin, Wald 2013,
// section 3.4, show that boxes must grow by what rounding does in the triangle test, or a ray along the border of two
// boxes is lost in between. In roundings of the farthest distance: 8 for a sheared vertex (see triangleDistanceError),
// 8 for an edge function, 5 for the slab distance itself (Ize 2013, "Robust BVH Ray Traversal": two operations and a
// division of 2.5 ulp); the rest is for the roundings of the padding.
const float kBoxPadding = 24.0 * kRoundingError;

// What no box entry distance is: entries are >= tMin >= 0.
const float kBoxMissed = -1.0;

struct BoxRay {
  vec3 origin;
  vec3 inverseDirection; // finite
  vec3 padding;          // distance along the ray by which a slab grows at either side
};

/// @param reach  largest coordinate difference between the origin and a corner of the tree's bounds
BoxRay makeBoxRay(const vec3 origin, const vec3 direction, const float reach) {
  const bvec3 parallel = lessThan(abs(direction), vec3(kSmallestSlabDirection));
  BoxRay ray;
  ray.origin = origin;
  ray.inverseDirection = mix(1.0 / mix(direction, vec3(1.0), parallel), vec3(kLargestSlabInverse), parallel);
  ray.padding = (kBoxPadding * reach) * abs(ray.inverseDirection);
  return ray;
}

/// The distance at which a ray enters a box, at least tMin, or kBoxMissed.
///
/// Slab test of Kay and Kajiya 1986.
/// @param lower, upper  lower > upper (in x): an absent box, always missed
/// @param tMin          >= 0
float enterBox(const BoxRay ray, const vec3 lower, const vec3 upper, const float tMin, const float tMax) {
  const vec3 t0 = (lower - ray.origin) * ray.inverseDirection;
  const vec3 t1 = (upper - ray.origin) * ray.inverseDirection;
  const vec3 near = min(t0, t1) - ray.padding;
  const vec3 far = max(t0, t1) + ray.padding;
  const float tNear = max(max(near.x, near.y), max(near.z, tMin));
  const float tFar = min(min(far.x, far.y), min(far.z, tMax));
  return tNear <= tFar && lower.x <= upper.x ? tNear : kBoxMissed;
}

#endif
