// Orthonormal frames.
#ifndef ISOPHOTE_MATH_FRAME_GLSL
#define ISOPHOTE_MATH_FRAME_GLSL

// Unit, mutually orthogonal; right-handed unless made from a mirrored tangent.
struct Frame {
  vec3 tangent;
  vec3 bitangent;
  vec3 normal;
};

/// Completes a unit normal to a right-handed frame.
///
/// Source: Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1), listing 3.
/// @param n  unit, world or any space
/// Accuracy: see tests/glsl/frame_test.cpp; the divisor sign + n.z is at least 1 in magnitude.
Frame frameFromNormal(vec3 n) {
  const float sign = n.z >= 0.0 ? 1.0 : -1.0;
  const float a = -1.0 / (sign + n.z);
  const float b = n.x * n.y * a;
  return Frame(vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), vec3(b, sign + n.y * n.y * a, -n.y), n);
}

/// A frame whose tangent is `tangent` made orthogonal to the normal (Gram-Schmidt).
///
/// @param n           unit
/// @param tangent     any length; where it is nearly parallel to n or shorter than 1e-15, frameFromNormal(n) is
/// returned
/// @param handedness  +1 or -1, the sign of the bitangent: bitangent = handedness * cross(n, tangent) (glTF TANGENT.w)
Frame frameFromNormalTangent(vec3 n, vec3 tangent, float handedness) {
  const vec3 t = tangent - dot(n, tangent) * n;
  const float squared = dot(t, t);
  // Below 1e-6 of the tangent's own length (1e-12 of its square) the difference is rounding error.
  if (!(squared > max(1e-12 * dot(tangent, tangent), 1e-30))) return frameFromNormal(n);
  const vec3 unit = t * inversesqrt(squared);
  return Frame(unit, handedness * cross(n, unit), n);
}

vec3 toLocal(const Frame frame, vec3 v) {
  return vec3(dot(frame.tangent, v), dot(frame.bitangent, v), dot(frame.normal, v));
}

vec3 toWorld(const Frame frame, vec3 v) { return v.x * frame.tangent + v.y * frame.bitangent + v.z * frame.normal; }

#endif
