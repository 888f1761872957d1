// Rays against spheres.
#ifndef ISOPHOTE_GEOMETRY_RAY_SPHERE_GLSL
#define ISOPHOTE_GEOMETRY_RAY_SPHERE_GLSL

struct SphereHit {
  bool found;
  float t;         // in units of the direction's length
  float halfChord; // half the ray's length within the sphere, in the same units
};

/// Where a ray first meets a sphere at t > tMin.
///
/// The discriminant is taken from the vector between the sphere's center and the point of the ray nearest to it, and
/// the smaller root as quotient of the roots' product and the larger one: neither cancels far from a small sphere, and
/// whether the ray starts inside is decided by one comparison.
/// Source: Haines, Guenther, Akenine-Moeller 2019, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing
/// Gems, chapter 7.
/// @param direction  any length
/// @param tMin       >= 0
SphereHit intersectSphere(const vec3 origin, const vec3 direction, const vec3 center, const float radius,
                          const float tMin) {
  const vec3 toCenter = center - origin;
  const float inverseSquare = 1.0 / dot(direction, direction);
  const float tNearest = dot(toCenter, direction) * inverseSquare;
  const vec3 nearest = toCenter - tNearest * direction;
  const float discriminant = radius * radius - dot(nearest, nearest);
  SphereHit hit = SphereHit(false, 0.0, 0.0);
  if (discriminant < 0.0) return hit;
  hit.halfChord = sqrt(discriminant * inverseSquare);
  const float larger = abs(tNearest) + hit.halfChord;
  if (!(larger > 0.0)) return hit;
  const float centerDistance = length(toCenter);
  // Negative from inside.
  const float product = (centerDistance - radius) * (centerDistance + radius) * inverseSquare;
  const float smaller = product / larger;
  const float tEnter = tNearest >= 0.0 ? smaller : -larger;
  const float tLeave = tNearest >= 0.0 ? larger : -smaller;
  hit.t = tEnter > tMin ? tEnter : tLeave;
  hit.found = hit.t > tMin;
  return hit;
}

#endif
