// The normal of a triangle, good for needles too.
#ifndef ISOPHOTE_GEOMETRY_TRIANGLE_NORMAL_GLSL
#define ISOPHOTE_GEOMETRY_TRIANGLE_NORMAL_GLSL

#include "geometry/exact_product.glsl"
#include "geometry/float_steps.glsl"

// scale^2 times the cross product of a triangle's edges; scale is a power of two that keeps it from under- and
// overflow.
struct EdgeCross {
  vec3 value;
  vec3 magnitude; // the same with all terms taken positive: value is known to 3 roundings of it
  float scale;
};

EdgeCross edgeCross(const vec3 a, const vec3 b, const float scale) {
  return EdgeCross(exactCross(a, b), abs(a.yzx * b.zxy) + abs(a.zxy * b.yzx), scale);
}

/// The cross product is taken at the vertex opposite to the longest edge: for needles of any aspect the result is then
/// as good as the vertices are.
/// @param e01, e12, e20  edges of the triangle, head to tail
EdgeCross crossEdges(const vec3 e01, const vec3 e12, const vec3 e20) {
  const vec3 extent = max(abs(e01), max(abs(e12), abs(e20)));
  const float scale = powerOfTwoInverse(max(extent.x, max(extent.y, extent.z)));
  const vec3 a = scale * e01;
  const vec3 b = scale * e12;
  const vec3 c = scale * e20;
  const vec3 squares = vec3(dot(a, a), dot(b, b), dot(c, c));
  if (squares.y >= squares.x && squares.y >= squares.z) return edgeCross(c, a, scale);
  if (squares.z >= squares.x) return edgeCross(a, b, scale);
  return edgeCross(b, c, scale);
}

#endif
