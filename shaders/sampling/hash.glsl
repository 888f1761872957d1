#ifndef ISOPHOTE_SAMPLING_HASH_GLSL
#define ISOPHOTE_SAMPLING_HASH_GLSL

/// Mixes 128 bits into 128 bits. A bijection: different keys never collide in all four words.
///
/// Source: Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", JCGT 9(3), pcg4d.
uvec4 pcg4d(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

/// Uniform float in [0, 1) from the upper 24 bits: every value is k * 2^-24, exactly.
float unitFloat(uint bits) { return float(bits >> 8u) * 5.9604644775390625e-8; }
vec2 unitFloat(uvec2 bits) { return vec2(unitFloat(bits.x), unitFloat(bits.y)); }

#endif
