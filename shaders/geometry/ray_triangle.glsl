// Rays against triangles without gaps: a ray that meets the shared edge or vertex of two triangles hits one of them.
#ifndef ISOPHOTE_GEOMETRY_RAY_TRIANGLE_GLSL
#define ISOPHOTE_GEOMETRY_RAY_TRIANGLE_GLSL

#include "geometry/exact_product.glsl"
#include "geometry/float_steps.glsl"
#include "geometry/triangle_normal.glsl"
#include "shared/constants.glsl"

struct TriangleRay {
  vec3 origin;
  vec3 direction;
  vec3 shear; // dx/dz, dy/dz, 1/dz of the direction with its largest component permuted to z
  uint axis;  // the component that goes to z
};

struct TriangleHit {
  bool found;
  float t;
  vec2 barycentrics; // weights of v1 and v2
};

// Below this an edge function may have lost bits to underflow, or is so close to the edge that exactness is cheap to
// buy.
const float kSmallestEdgeFunction = 8.077936e-28; // 2^-90

// Twice the area of a projected triangle, scaled to coordinates near 1, below which it counts as seen edge-on:
// the division by it would leave the range where Vulkan bounds division's error.
const float kSmallestDeterminant = 7.523164e-37; // 2^-120

vec3 permuteToZ(const vec3 v, const uint axis) { return axis == 0u ? v.yzx : axis == 1u ? v.zxy : v.xyz; }

TriangleRay makeTriangleRay(const vec3 origin, const vec3 direction) {
  const vec3 a = abs(direction);
  TriangleRay ray;
  ray.origin = origin;
  ray.direction = direction;
  ray.axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
  const vec3 d = permuteToZ(direction, ray.axis);
  ray.shear = vec3(d.x / d.z, d.y / d.z, 1.0 / d.z);
  return ray;
}

// Vertex in the ray's frame: xy sheared onto the plane across the ray, z along the permuted axis, unscaled.
// `precise`: a vertex shared by two triangles must come out with the same bits in both.
vec3 shearVertex(const TriangleRay ray, const vec3 v) {
  precise vec3 p = permuteToZ(v - ray.origin, ray.axis);
  precise vec2 xy = vec2(p.x - ray.shear.x * p.z, p.y - ray.shear.y * p.z);
  return vec3(xy, p.z);
}

// a.x * b.y - a.y * b.x, rounded once from each product: its sign never contradicts the exact one, and
// swapping a and b negates it.
float edgeFunction(const vec2 a, const vec2 b) {
  precise float left = a.x * b.y;
  precise float right = a.y * b.x;
  precise float difference = left - right;
  return difference;
}

/// Bounds the error of the t that the edge functions give: beyond it, the sign of t is certain.
///
/// Source: Pharr, Jakob, Humphreys 2023, "Physically Based Rendering" 4ed, section 6.8.7, with these changes: each
/// rounding counts 2^-23 and division 2.5 of them, and z is taken before and after the scaling by 1/dz, since the
/// direction need not be unit.
/// @param a, b, c  sheared vertices in any common scale of x and y; `scale` is that scale
/// @param edges    edge functions in the square of that scale; inverseDeterminant is 1 / their sum
float triangleDistanceError(const vec3 a, const vec3 b, const vec3 c, const float scale, const vec3 edges,
                            const float inverseDeterminant, const float inverseDirection) {
  const float maxX = max(abs(a.x), max(abs(b.x), abs(c.x)));
  const float maxY = max(abs(a.y), max(abs(b.y), abs(c.y)));
  const float maxZ = max(abs(a.z), max(abs(b.z), abs(c.z)));
  const float maxT = maxZ * abs(inverseDirection);
  const float deltaT = 5.0 * kRoundingError * maxT;
  const float deltaX = 8.0 * kRoundingError * (maxX + scale * maxZ);
  const float deltaY = 8.0 * kRoundingError * (maxY + scale * maxZ);
  const float deltaEdge = 2.0 * (2.0 * kRoundingError * maxX * maxY + deltaY * maxX + deltaX * maxY);
  const float maxEdge = max(abs(edges.x), max(abs(edges.y), abs(edges.z)));
  return 3.0 * (3.0 * kRoundingError * maxEdge * maxT + deltaEdge * maxT + deltaT * maxEdge) * abs(inverseDeterminant);
}

/// The distance to the triangle's plane where it is certainly ahead of the origin, else 0.
///
/// For what triangleDistanceError leaves open: the triangle that a ray has just left, one that it is about to meet,
/// needles. Edge functions lose t by the triangle's extent across the ray, which for a wide triangle seen at an angle,
/// or for a needle, exceeds t itself; the plane's equation at the nearest vertex loses no more than some roundings of
/// the distance to that vertex. Roundings of the sum below: 1 for the vertex relative to the origin, 3 for product and
/// sums, 2 for the cross product (in value), 2 for its edges (in magnitude).
float distanceAhead(const TriangleRay ray, const vec3 v0, const vec3 v1, const vec3 v2) {
  const EdgeCross normal = crossEdges(v1 - v0, v2 - v1, v0 - v2);
  const vec3 a = v0 - ray.origin;
  const vec3 b = v1 - ray.origin;
  const vec3 c = v2 - ray.origin;
  const vec3 squares = vec3(dot(a, a), dot(b, b), dot(c, c));
  const vec3 nearest = squares.x <= squares.y && squares.x <= squares.z ? a : squares.y <= squares.z ? b : c;
  precise float height = normal.value.x * nearest.x + normal.value.y * nearest.y + normal.value.z * nearest.z;
  const float speed = dot(normal.value, ray.direction);
  const vec3 extent = abs(nearest);
  const float error = kRoundingError * (6.0 * dot(abs(normal.value), extent) + 2.0 * dot(normal.magnitude, extent));
  if (abs(speed) < kSmallestDeterminant) return 0.0;
  const float ahead = speed > 0.0 ? height : -height;
  return ahead > error ? ahead / abs(speed) : 0.0;
}

/// Two-sided test of the setting intersection=fast: both triangles at an edge may miss a ray that meets it, and a
/// triangle may be found behind its own ray's origin by rounding.
///
/// Source: Moeller, Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1).
TriangleHit intersectTriangleFast(const TriangleRay ray, const vec3 v0, const vec3 v1, const vec3 v2) {
  const vec3 edge1 = v1 - v0;
  const vec3 edge2 = v2 - v0;
  const vec3 across = cross(ray.direction, edge2);
  const float inverse = 1.0 / dot(edge1, across); // infinite where the triangle is seen edge-on: no comparison holds
  const vec3 from = ray.origin - v0;
  const float b1 = dot(from, across) * inverse;
  const vec3 turned = cross(from, edge1);
  const float b2 = dot(ray.direction, turned) * inverse;
  const float t = dot(edge2, turned) * inverse;
  return TriangleHit(b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0 && t > 0.0, t, vec2(b1, b2));
}

/// Two-sided watertight test.
///
/// Source: Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1). Their double-precision fallback
/// is replaced by exact products of power-of-two-scaled floats, which also serves triangles so small that edge
/// functions underflow.
/// @param v0, v1, v2  in the ray's space, |coordinate| <= 2^60
/// @return            t in units of the direction's length; found only where the triangle is certainly ahead
TriangleHit intersectTriangle(const TriangleRay ray, const vec3 v0, const vec3 v1, const vec3 v2) {
  if (kIntersection == 1u) return intersectTriangleFast(ray, v0, v1, v2);
  TriangleHit hit;
  hit.found = false;
  hit.t = 0.0;
  hit.barycentrics = vec2(0.0);

  vec3 a = shearVertex(ray, v0);
  vec3 b = shearVertex(ray, v1);
  vec3 c = shearVertex(ray, v2);
  vec3 edges = vec3(edgeFunction(c.xy, b.xy), edgeFunction(a.xy, c.xy), edgeFunction(b.xy, a.xy));
  float scale = 1.0;
  if (min(abs(edges.x), min(abs(edges.y), abs(edges.z))) < kSmallestEdgeFunction) {
    const vec2 largest = max(abs(a.xy), max(abs(b.xy), abs(c.xy)));
    scale = powerOfTwoInverse(max(largest.x, largest.y));
    a.xy *= scale;
    b.xy *= scale;
    c.xy *= scale;
    edges = vec3(differenceOfProducts(c.x, b.y, c.y, b.x), differenceOfProducts(a.x, c.y, a.y, c.x),
                 differenceOfProducts(b.x, a.y, b.y, a.x));
  }
  if (any(lessThan(edges, vec3(0.0))) && any(greaterThan(edges, vec3(0.0)))) return hit;
  precise float determinant = edges.x + edges.y + edges.z;
  if (abs(determinant) < kSmallestDeterminant) return hit;

  const float inverse = 1.0 / determinant;
  precise float weighted = edges.x * a.z + edges.y * b.z + edges.z * c.z;
  precise float t = weighted * ray.shear.z * inverse;
  const float error = triangleDistanceError(a, b, c, scale, edges, inverse, ray.shear.z);
  if (t < -error) return hit;
  hit.t = t > error ? t : distanceAhead(ray, v0, v1, v2);
  hit.found = hit.t > 0.0;
  hit.barycentrics = edges.yz * inverse;
  return hit;
}

#endif
