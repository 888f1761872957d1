// Rays against axis-aligned boxes: never misses a box that the exact ray touches.
#ifndef ISOPHOTE_GEOMETRY_RAY_BOX_GLSL
#define ISOPHOTE_GEOMETRY_RAY_BOX_GLSL

// Direction components below 2^-90 count as 2^-90 for the slabs' distances, and their far distance gains 2^60: the
// slab then holds every point within 2^-30 of it, so an origin exactly on a face is inside. This loses nothing up to
// t = 2^59, where such a component moves the ray by less than that.
const float kSmallestSlabDirection = 8.077936e-28; // 2^-90
const float kLargestSlabInverse = 1.2379400e27;    // 2^90
const float kParallelSlabPad = 1.1529215e18;       // 2^60

// Far distances are scaled up by twice the relative error of one slab distance (Ize 2013, "Robust BVH Ray Traversal",
// section 3): subtraction and product 1 ulp each, division 2.5 ulp, with ulp <= 2^-23 in any rounding mode;
// 1 + 2 * 4.5 * 2^-23, and one more 2^-23 for this product itself.
const float kSlabFarScale = 1.0000012;

// What no box entry distance is: entries are >= tMin >= 0.
const float kBoxMissed = -1.0;

struct BoxRay {
  vec3 origin;
  vec3 inverseDirection; // finite
  vec3 farPad;
};

BoxRay makeBoxRay(const vec3 origin, const vec3 direction) {
  const bvec3 parallel = lessThan(abs(direction), vec3(kSmallestSlabDirection));
  const vec3 safe = mix(direction, vec3(1.0), parallel);
  BoxRay ray;
  ray.origin = origin;
  ray.inverseDirection = mix(1.0 / safe, vec3(kLargestSlabInverse), parallel);
  ray.farPad = mix(vec3(0.0), vec3(kParallelSlabPad), parallel);
  return ray;
}

/// The distance at which a ray enters a box, at least tMin, or kBoxMissed.
///
/// Slab test of Kay and Kajiya 1986 with the bounds of Ize 2013.
/// @param lower, upper  lower > upper (in x): an absent box, always missed
/// @param tMin          >= 0
/// @param tLimit        farthest distance of interest, already scaled by kSlabFarScale
float enterBox(const BoxRay ray, const vec3 lower, const vec3 upper, const float tMin, const float tLimit) {
  const vec3 t0 = (lower - ray.origin) * ray.inverseDirection;
  const vec3 t1 = (upper - ray.origin) * ray.inverseDirection;
  const vec3 near = min(t0, t1);
  const vec3 far = max(t0, t1) * kSlabFarScale + ray.farPad;
  const float tNear = max(max(near.x, near.y), max(near.z, tMin));
  const float tFar = min(min(far.x, far.y), min(far.z, tLimit));
  return tNear <= tFar && lower.x <= upper.x ? tNear : kBoxMissed;
}

#endif
