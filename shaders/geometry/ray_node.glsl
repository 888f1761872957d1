// Rays against the boxes of a node's children: never misses a box whose content the triangle test would find.
#ifndef ISOPHOTE_GEOMETRY_RAY_NODE_GLSL
#define ISOPHOTE_GEOMETRY_RAY_NODE_GLSL

#include "geometry/float_steps.glsl"
#include "shared/buffers.glsl"

// Direction components below 2^-60 count as 2^-60. The near distance of such a slab can only come out smaller than it
// is, and the far one gains more from the padding than the ray moves, up to t = 1e12 times the farthest corner's
// distance.
const float kSmallestSlabDirection = 8.6736174e-19; // 2^-60
const float kLargestSlabInverse = 1.1529215e18;     // 2^60

// Boxes are padded by this times the distance of the farthest corner of the tree. Woop, Benthin, Wald 2013,
// section 3.4, show that boxes must grow by what rounding does in the triangle test, or a ray along the border of two
// boxes is lost in between. In roundings of the farthest distance: 8 for a sheared vertex (see triangleDistanceError),
// 8 for an edge function, 4 for the origin of a frame relative to the ray's and the division (Ize 2013, "Robust BVH Ray
// Traversal"), 18 for the product with a frame's size (at most 8 times the farthest distance: the frame is less than
// 2.01 times as wide as the tree, which is at most twice as wide as the farthest corner is away, and a cell counts from
// 1 to 2) and the difference from it; the rest is for the roundings of the padding.
const float kBoxPadding = 48.0 * kRoundingError;

// Of BvhNode.contents and of groups.
const uint kChildBits = 0xff000000u;
const uint kItemBits = 0x00ffffffu;
const uint kLowestChildBit = 1u << kBvhInnerShift;

struct NodeRay {
  vec3 origin;
  vec3 inverseDirection; // finite
  vec3 padding;          // distance along the ray by which a slab grows at either side
  bvec3 backward;        // whether the ray meets upper sides first
  uint order;            // slot ^ order: 7 for the first to visit, 0 for the last
};

// Corner and size of a node's frame.
struct NodeFrame {
  vec3 origin;
  vec3 size;
};

struct NodeContents {
  uint present; // bits of BvhNode.contents that are items
  uint firstItem;
};

// What a ray hits of a node.
struct NodeHits {
  uint firstChild;
  uint group; // inner children: see traverse_bvh.glsl
  uint firstItem;
  uint items; // bits of BvhNode.contents
  uint present;
};

BvhNodeRef nodeAt(const uint64_t nodes, const uint index) {
  return BvhNodeRef(nodes + uint64_t(index) * uint64_t(kBvhNodeBytes));
}

vec3 frameSize(const uint exponents) {
  return uintBitsToFloat((uvec3(exponents << 23u, exponents << 15u, exponents << 7u)) & 0x7f800000u);
}

NodeFrame readFrame(const uint64_t nodes, const uint index) {
  BvhNodeRef node = nodeAt(nodes, index);
  const uvec2 xy = unpackUint2x32(node.words[0]);
  const uvec2 ze = unpackUint2x32(node.words[1]);
  return NodeFrame(uintBitsToFloat(uvec3(xy, ze.x)), frameSize(ze.y));
}

NodeContents readContents(const uint64_t nodes, const uint index) {
  BvhNodeRef node = nodeAt(nodes, index);
  return NodeContents(unpackUint2x32(node.words[2]).x & kItemBits, unpackUint2x32(node.words[3]).x);
}

/// @param root  frame of the tree's root
NodeRay makeNodeRay(const vec3 origin, const vec3 direction, const NodeFrame root) {
  const vec3 farthest = max(abs(root.origin - origin), abs(root.origin + root.size - origin));
  const float reach = max(farthest.x, max(farthest.y, farthest.z));
  const bvec3 parallel = lessThan(abs(direction), vec3(kSmallestSlabDirection));
  NodeRay ray;
  ray.origin = origin;
  ray.inverseDirection = mix(1.0 / mix(direction, vec3(1.0), parallel), vec3(kLargestSlabInverse), parallel);
  ray.padding = (kBoxPadding * reach) * abs(ray.inverseDirection);
  ray.backward = lessThan(ray.inverseDirection, vec3(0.0));
  ray.order = 7u ^ ((ray.backward.x ? 1u : 0u) | (ray.backward.y ? 2u : 0u) | (ray.backward.z ? 4u : 0u));
  return ray;
}

// The root as a group of its own: slot 0 of nothing.
uint rootGroup(const NodeRay ray) { return 1u << (kBvhInnerShift + ray.order); }

// Cells of four slots as 1 + cell / 256, without a conversion.
vec4 cells(const uint word) {
  return uintBitsToFloat((uvec4(word << 15u, word << 7u, word >> 1u, word >> 9u) & 0x7f8000u) | 0x3f800000u);
}

// Which of four slots are hit, as bits of BvhNode.contents from slot 0 on.
uint hitSlots(const uvec3 near, const uvec3 far, const vec3 scale, const vec3 nearBase, const vec3 farBase,
              const int tMin, const int tMax) {
  // As integers: where any distance is positive the larger float is the larger integer, and a negative one is below
  // tMin whichever it is.
  const ivec4 t0 = max(
      max(floatBitsToInt(cells(near.x) * scale.x + nearBase.x), floatBitsToInt(cells(near.y) * scale.y + nearBase.y)),
      max(floatBitsToInt(cells(near.z) * scale.z + nearBase.z), ivec4(tMin)));
  const ivec4 t1 =
      min(min(floatBitsToInt(cells(far.x) * scale.x + farBase.x), floatBitsToInt(cells(far.y) * scale.y + farBase.y)),
          min(floatBitsToInt(cells(far.z) * scale.z + farBase.z), ivec4(tMax)));
  return (t0.x <= t1.x ? 0x1000007u : 0u) | (t0.y <= t1.y ? 0x2000038u : 0u) | (t0.z <= t1.z ? 0x40001c0u : 0u) |
         (t0.w <= t1.w ? 0x8000e00u : 0u);
}

// Bit 24 + s to bit 24 + (s ^ order).
uint inVisitOrder(const uint slots, const uint order) {
  uint bits = slots;
  bits = (order & 1u) != 0u ? (bits & 0x55000000u) << 1u | (bits >> 1u & 0x55000000u) : bits;
  bits = (order & 2u) != 0u ? (bits & 0x33000000u) << 2u | (bits >> 2u & 0x33000000u) : bits;
  return (order & 4u) != 0u ? (bits & 0x0f000000u) << 4u | (bits >> 4u & 0x0f000000u) : bits;
}

/// Which children a ray meets between tMin and tMax.
///
/// Slab test of Kay and Kajiya 1986 in the node's frame.
/// @param tMin  >= 0
NodeHits enterNode(const uint64_t nodes, const uint index, const NodeRay ray, const float tMin, const float tMax) {
  BvhNodeRef node = nodeAt(nodes, index);
  const uvec2 xy = unpackUint2x32(node.words[0]);
  const uvec2 ze = unpackUint2x32(node.words[1]);
  const uvec2 cf = unpackUint2x32(node.words[2]);
  const uint firstItem = unpackUint2x32(node.words[3]).x;
  const uvec2 lowerX = unpackUint2x32(node.words[4]);
  const uvec2 lowerY = unpackUint2x32(node.words[5]);
  const uvec2 lowerZ = unpackUint2x32(node.words[6]);
  const uvec2 upperX = unpackUint2x32(node.words[7]);
  const uvec2 upperY = unpackUint2x32(node.words[8]);
  const uvec2 upperZ = unpackUint2x32(node.words[9]);
  const vec3 scale = frameSize(ze.y) * ray.inverseDirection;
  const vec3 base = (uintBitsToFloat(uvec3(xy, ze.x)) - ray.origin) * ray.inverseDirection - scale;
  const vec3 nearBase = base - ray.padding;
  const vec3 farBase = base + ray.padding;
  const uvec2 nearX = ray.backward.x ? upperX : lowerX;
  const uvec2 farX = ray.backward.x ? lowerX : upperX;
  const uvec2 nearY = ray.backward.y ? upperY : lowerY;
  const uvec2 farY = ray.backward.y ? lowerY : upperY;
  const uvec2 nearZ = ray.backward.z ? upperZ : lowerZ;
  const uvec2 farZ = ray.backward.z ? lowerZ : upperZ;
  const int t0 = floatBitsToInt(tMin);
  const int t1 = floatBitsToInt(tMax);
  const uint low =
      hitSlots(uvec3(nearX.x, nearY.x, nearZ.x), uvec3(farX.x, farY.x, farZ.x), scale, nearBase, farBase, t0, t1);
  const uint high =
      hitSlots(uvec3(nearX.y, nearY.y, nearZ.y), uvec3(farX.y, farY.y, farZ.y), scale, nearBase, farBase, t0, t1);
  const uint hit = (low | (high & 0xf000000u) << 4u | (high & 0xfffu) << 12u) & cf.x;
  NodeHits hits;
  hits.firstChild = cf.y;
  hits.group = inVisitOrder(hit & kChildBits, ray.order) | cf.x >> kBvhInnerShift;
  hits.firstItem = firstItem;
  hits.items = hit & kItemBits;
  hits.present = cf.x & kItemBits;
  return hits;
}

#endif
