// Uniform sampling of the directions in which a triangle is seen.
//
// Source: Arvo 1995, "Stratified Sampling of Spherical Triangles"; without angles as in Peters 2021, "BRDF Importance
// Sampling for Polygonal Lights", section 4: a vertex of the subtriangle is the first vertex mirrored at an offset that
// is linear in two sides' sums, see tests/oracle/spherical_triangle.hpp for the derivation.
#ifndef ISOPHOTE_LIGHT_SPHERICAL_TRIANGLE_GLSL
#define ISOPHOTE_LIGHT_SPHERICAL_TRIANGLE_GLSL

#include "math/constants.glsl"
#include "math/trigonometry.glsl"

// Outside these solid angles a triangle is sampled by area: smaller ones gain nothing, larger ones nearly surround the
// receiver and their edges become unstable. As in pbrt-v4.
const float kSmallestSphericalTriangle = 3e-4;
const float kLargestSphericalTriangle = 6.22;

struct SphericalTriangle {
  vec3 directions[3]; // unit, from the receiver to the vertices
  vec3 inverseDistances;
  float volume;     // |det(directions)|
  float sum01;      // 1 + d0 . d1
  float sum2;       // d0 . d2 + d1 . d2
  float solidAngle; // steradian, in [0, 2 pi]
};

/// @param p           receiver
/// @param v0, v1, v2  vertices
SphericalTriangle sphericalTriangle(vec3 p, vec3 v0, vec3 v1, vec3 v2) {
  SphericalTriangle t;
  const vec3 a = v0 - p;
  const vec3 b = v1 - p;
  const vec3 c = v2 - p;
  // A receiver at a vertex gets solid angle 0.
  t.inverseDistances = inversesqrt(max(vec3(dot(a, a), dot(b, b), dot(c, c)), vec3(1e-37)));
  t.directions[0] = a * t.inverseDistances.x;
  t.directions[1] = b * t.inverseDistances.y;
  t.directions[2] = c * t.inverseDistances.z;
  // The determinant from the edges, which small triangles know exactly; normalised last.
  const vec3 e1 = (v1 - v0) * t.inverseDistances.y;
  const vec3 e2 = (v2 - v0) * t.inverseDistances.z;
  t.volume = abs(dot(t.directions[0], cross(e1, e2)));
  t.sum01 = 1.0 + dot(t.directions[0], t.directions[1]);
  t.sum2 = dot(t.directions[0], t.directions[2]) + dot(t.directions[1], t.directions[2]);
  // Van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle".
  t.solidAngle = 2.0 * kPi * atan2Pi(t.volume, t.sum01 + t.sum2);
  return t;
}

/// Whether the triangle is sampled by solid angle. False for NaN, too.
bool isStable(const SphericalTriangle t) {
  return t.solidAngle >= kSmallestSphericalTriangle && t.solidAngle <= kLargestSphericalTriangle;
}

/// Barycentric weights of the three vertices at a point whose direction is uniform: pdf 1 / solidAngle.
///
/// @param t  stable
/// @param u  in [0, 1)
/// @return   each >= 0, sum 1 to rounding
vec3 sampleSphericalTriangle(const SphericalTriangle t, vec2 u) {
  const vec3 d0 = t.directions[0];
  const vec3 d1 = t.directions[1];
  const vec3 d2 = t.directions[2];
  // (d0, d1, x) has the share u.x of the solid angle; x mirrors d0 at `middle`, between d0 and d2.
  const vec2 sinCos = sinCosPi(u.x * t.solidAngle * (0.5 * kInvPi));
  const float weight0 = t.volume * sinCos.y - t.sum2 * sinCos.x;
  const float weight2 = t.sum01 * sinCos.x;
  const vec3 middle = d0 * weight0 + d2 * weight2;
  const float mirror = 2.0 * dot(d0, middle) / dot(middle, middle);
  const float x0 = mirror * weight0 - 1.0;
  const float x2 = mirror * weight2;
  const vec3 x = d0 * x0 + d2 * x2;
  // On the arc from d1 to x, uniform in the cosine to d1. 1 - cosine by the chord, without cancellation.
  const vec3 chord = d1 - x;
  const float oneMinusCos = 0.5 * dot(chord, chord);
  const float along = sqrt(u.y * (2.0 - u.y * oneMinusCos) / max(2.0 - oneMinusCos, 1e-6));
  const vec3 weights = vec3(along * x0, (1.0 - along) + oneMinusCos * (along - u.y), along * x2);
  // The direction as a sum of directions to vertices; the same sum of the vertices themselves hits the plane.
  const vec3 barycentrics = max(weights * t.inverseDistances, vec3(0.0));
  return barycentrics / (barycentrics.x + barycentrics.y + barycentrics.z);
}

#endif
