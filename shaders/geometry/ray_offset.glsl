// Origins of rays that leave a surface: moved just beyond what rounding may have done to the hit point.
#ifndef ISOPHOTE_GEOMETRY_RAY_OFFSET_GLSL
#define ISOPHOTE_GEOMETRY_RAY_OFFSET_GLSL

#include "geometry/affine.glsl"
#include "geometry/float_steps.glsl"
#include "shared/constants.glsl"

// Of the setting ray-offset=fixed, in scene units: wrong at some scale, as every such distance.
const float kFixedRayOffset = 1e-4;

// A point and how far, per axis, the exact one may be from it.
struct HitPoint {
  vec3 p;
  vec3 pError;
};

/// The point of a triangle with barycentric weights (b1, b2) of v1 and v2, in the triangle's space.
///
/// v0 + b1 (v1 - v0) + b2 (v2 - v0) lies in the plane for any b1, b2, so only the roundings of its evaluation count: at
/// most two on v0 (the sums) and four on the others (difference, product, sums). The decimals pay for second order
/// terms.
HitPoint pointOnTriangle(const vec3 v0, const vec3 v1, const vec3 v2, const vec2 barycentrics) {
  precise vec3 along1 = barycentrics.x * (v1 - v0);
  precise vec3 along2 = barycentrics.y * (v2 - v0);
  precise vec3 p = (v0 + along1) + along2;
  return HitPoint(p, kRoundingError * (2.1 * abs(v0) + 4.1 * (abs(along1) + abs(along2))));
}

/// Takes a hit point to world space.
///
/// The bound covers this map (half a rounding for its entries, one for products, two for sums), and the inverse map by
/// which a ray from the result will be taken back to object space (the same count, mapped to world space again).
/// Far from the origin the terms with the translations dominate.
HitPoint hitPointToWorld(const HitPoint hit, const Affine worldFromObject, const Affine objectFromWorld) {
  const vec3 p = transformPoint(worldFromObject, hit.p);
  const vec3 forward = transformExtent(worldFromObject, abs(hit.p)) + abs(translationOf(worldFromObject));
  const vec3 back = transformExtent(objectFromWorld, abs(p)) + abs(translationOf(objectFromWorld));
  const vec3 error = transformExtent(worldFromObject, hit.pError + 4.1 * kRoundingError * back);
  return HitPoint(p, 1.00001 * error + 4.1 * kRoundingError * forward);
}

/// Where a ray from a surface point in direction w starts: on the side of the surface that w points to, outside the box
/// of half extents pError around p.
///
/// Source: Pharr, Jakob, Humphreys 2023, "Physically Based Rendering" 4ed, section 6.8.6.
/// @param ng  unit geometric normal, either side
/// @param w   direction of the ray, any length
/// Accuracy: bit-equal to the same operations in C++, tests/glsl/offset_test.cpp.
vec3 offsetRayOrigin(const vec3 p, const vec3 pError, const vec3 ng, const vec3 w) {
  if (kRayOffset == 1u) return p + (dot(w, ng) < 0.0 ? -kFixedRayOffset : kFixedRayOffset) * ng;
  precise float distance = (abs(ng.x) * pError.x + abs(ng.y) * pError.y) + abs(ng.z) * pError.z;
  const float side = dot(w, ng) < 0.0 ? -distance : distance;
  precise vec3 offset = side * ng;
  precise vec3 origin = p + offset;
  for (int axis = 0; axis < 3; ++axis) {
    if (offset[axis] > 0.0) {
      origin[axis] = nextFloatUp(origin[axis]);
    } else if (offset[axis] < 0.0) {
      origin[axis] = nextFloatDown(origin[axis]);
    }
  }
  return origin;
}

#endif
