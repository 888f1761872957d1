// Which light, by what each can do at the receiver: a descent through a tree of lights.
// Source: Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", section 5,
// without splitting: one light is chosen.
#ifndef ISOPHOTE_LIGHT_LIGHT_TREE_GLSL
#define ISOPHOTE_LIGHT_LIGHT_TREE_GLSL

#include "light/light_choice_result.glsl"
#include "shared/buffers.glsl"

// Slack of cosines: above the rounding of sqrt(1 - cos^2), 3e-4, so that no light that reaches the receiver is left
// out.
const float kCosineSlack = 2e-3;
// Bounds of cosines count as at least this, so that light at grazing angles is rare rather than missing.
const float kSmallestCosine = 0.01;
// Squared distances count as at least this, in the tree's lengths.
const float kSmallestSquaredDistance = 1e-14;

/// cos(max(a - b, 0)) of angles in [0, pi]. x, y: cosine and sine.
float cosDifference(vec2 a, vec2 b) { return a.x > b.x ? 1.0 : a.x * b.x + a.y * b.y; }

/// sin(max(a - b, 0)).
float sinDifference(vec2 a, vec2 b) { return a.x > b.x ? 0.0 : a.y * b.x - a.x * b.y; }

vec2 withSine(float cosine) { return vec2(cosine, sqrt(max(1.0 - cosine * cosine, 0.0))); }

vec3 decodeOctahedral(uint bits) {
  const vec2 p = unpackSnorm2x16(bits);
  vec3 v = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (v.z < 0.0) {
    v.x = p.x < 0.0 ? abs(p.y) - 1.0 : 1.0 - abs(p.y);
    v.y = p.y < 0.0 ? abs(p.x) - 1.0 : 1.0 - abs(p.x);
  }
  return normalize(v);
}

/// An estimate of the irradiance from a cluster of lights, never 0 where one of them can reach the receiver.
///
/// @param at  position in the tree's lengths
float lightImportance(const LightTreeNode node, const LightReceiver at) {
  if (node.radius == kLightTreeFixed) return node.intensity;
  const vec3 toReceiver = at.p - node.center;
  const float squaredRadius = max(node.radius * node.radius, kSmallestSquaredDistance);
  const float squaredDistance = dot(toReceiver, toReceiver);
  const float irradiance = node.intensity / max(squaredDistance, squaredRadius);
  if (squaredDistance <= squaredRadius) return irradiance; // within the cluster every direction is possible

  const vec3 direction = toReceiver * inversesqrt(squaredDistance);
  const float squaredSineB = squaredRadius / squaredDistance; // the cluster's angular radius
  const vec2 b = vec2(sqrt(1.0 - squaredSineB), sqrt(squaredSineB));
  const vec2 cosines = unpackSnorm2x16(node.cosines);
  float cosAxis = dot(decodeOctahedral(node.axis), direction);
  if ((node.child & kLightTreeTwoSided) != 0u) cosAxis = abs(cosAxis);
  const vec2 w = withSine(cosAxis);
  const vec2 o = withSine(cosines.x);
  const float cosEmission = cosDifference(vec2(cosDifference(w, o), sinDifference(w, o)), b);
  if (cosEmission < cosines.y - kCosineSlack) return 0.0;
  float cosReceiver = 1.0;
  if (at.ns != vec3(0.0)) cosReceiver = cosDifference(withSine(-dot(at.ns, direction)), b);
  if (cosReceiver < -kCosineSlack) return 0.0;
  return irradiance * max(cosEmission, kSmallestCosine) * max(cosReceiver, kSmallestCosine);
}

// How a node divides its probability: the first child gets firstShare / 2^32, where neither gets all or nothing.
struct LightTreeDivision {
  bool firstPossible;
  bool secondPossible;
  uint firstShare; // [1, 2^32 - 1] where both are possible
};

LightTreeDivision divideLights(const LightTreeRef tree, uint firstChild, const LightReceiver at) {
  const float first = lightImportance(tree.items[firstChild], at);
  const float second = lightImportance(tree.items[firstChild + 1u], at);
  const float share = first > 0.0 ? first / (first + second) * 4294967296.0 : 0.0;
  return LightTreeDivision(first > 0.0, second > 0.0, uint(clamp(share, 1.0, 4294967040.0)));
}

/// Probability of the second or first child, as the integer division has it.
float childProbability(const LightTreeDivision division, bool second) {
  if (!division.firstPossible || !division.secondPossible) {
    return (second ? division.secondPossible : division.firstPossible) ? 1.0 : 0.0;
  }
  return float(second ? 0u - division.firstShare : division.firstShare) * 2.3283064365386963e-10; // 2^-32
}

LightReceiver inTreeLengths(const SceneRef scene, const LightReceiver at) {
  return LightReceiver(at.p * scene.view.lightTreeScale, at.ns);
}

/// Chooses a light. No light can reach the receiver: pmf 0.
///
/// The two fractions make one number of 64 bits, which is followed into ever smaller intervals: one point of the
/// sampler decides all levels, keeps its stratification, and a light of probability 1e-12 still gets its share.
/// @param bits  two uniform 32-bit fractions
LightChoice chooseFromLightTree(const SceneRef scene, const LightReceiver receiver, uvec2 bits) {
  LightTreeRef tree = LightTreeRef(scene.view.lightTree);
  const LightReceiver at = inTreeLengths(scene, receiver);
  uint64_t place = (uint64_t(bits.x) << 32) | uint64_t(bits.y);
  uint64_t width = ~uint64_t(0);
  float pmf = 1.0;
  uint child = tree.items[0].child;
  for (uint depth = 0u; depth < kLightTreeMaxDepth && (child & kLightTreeLeaf) == 0u; ++depth) {
    const uint first = child & kLightTreeIndexMask;
    const LightTreeDivision division = divideLights(tree, first, at);
    if (!division.firstPossible && !division.secondPossible) return LightChoice(kInvalidIndex, 0.0);
    bool second = !division.firstPossible;
    if (division.firstPossible && division.secondPossible) {
      const uint64_t share = uint64_t(division.firstShare);
      const uint64_t middle = (width >> 32) * share + (((width & 0xfffffffful) * share) >> 32);
      second = place >= middle;
      place -= second ? middle : uint64_t(0);
      width = second ? width - middle : middle;
    }
    pmf *= childProbability(division, second);
    child = tree.items[first + uint(second)].child;
  }
  return LightChoice(child & kLightTreeIndexMask, pmf);
}

/// Probability with which chooseFromLightTree chooses light `index`; 0 where it never does.
float lightTreePmf(const SceneRef scene, const LightReceiver receiver, uint index) {
  LightTreeRef tree = LightTreeRef(scene.view.lightTree);
  const LightReceiver at = inTreeLengths(scene, receiver);
  uint trail = UintRef(scene.view.lightTrails).items[index];
  if (trail == kNoLightTrail) return 0.0;
  float pmf = 1.0;
  uint child = tree.items[0].child;
  for (uint depth = 0u; depth < kLightTreeMaxDepth && (child & kLightTreeLeaf) == 0u && pmf > 0.0; ++depth) {
    const uint first = child & kLightTreeIndexMask;
    const bool second = (trail & 1u) != 0u;
    pmf *= childProbability(divideLights(tree, first, at), second);
    child = tree.items[first + uint(second)].child;
    trail >>= 1;
  }
  return pmf;
}

#endif
