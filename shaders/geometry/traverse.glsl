// Closest hit and occlusion over the two-level BVH.
#ifndef ISOPHOTE_GEOMETRY_TRAVERSE_GLSL
#define ISOPHOTE_GEOMETRY_TRAVERSE_GLSL

#include "geometry/alpha_test.glsl"
#include "geometry/instance_map.glsl"
#include "geometry/ray_box.glsl"
#include "geometry/ray_sphere.glsl"
#include "geometry/ray_triangle.glsl"

struct RayHit {
  float t;           // in units of the direction's length
  uint instance;     // index into the InstanceRecord array
  uint triangle;     // index into the BvhTriangle array; kInvalidIndex: a sphere light
  vec2 barycentrics; // weights of v1 and v2
  bool found;
  bool stackOverflow; // never, while the builder keeps to kMaxBvhDepth
};

// What is still to be visited: a node (count 0) or `count` leaf items, as index | count << kWorkCountShift.
const uint kWorkCountShift = 29u;
const uint kWorkIndexMask = (1u << kWorkCountShift) - 1u;
const uint kNoWork = 0xffffffffu;

// A path through one level leaves at most one sibling per inner node; the rest of a top-level leaf is one more.
const uint kTraversalStackSize = 2u * kMaxBvhDepth + 1u;

const uint kTopLevel = kInvalidIndex; // in place of an instance

// Equal distances go to the smaller (instance, triangle), so that the order of visits does not matter.
bool isCloser(const float t, const uint instance, const uint triangle, const RayHit best) {
  if (t != best.t || !best.found) return t < best.t;
  return instance < best.instance || (instance == best.instance && triangle < best.triangle);
}

// Largest coordinate difference between a point and a corner of the boxes in a tree's root.
float reachOf(const BvhNode root, const vec3 origin) {
  vec3 farthest = max(abs(root.lower0 - origin), abs(root.upper0 - origin));
  if (root.lower1.x <= root.upper1.x) {
    farthest = max(farthest, max(abs(root.lower1 - origin), abs(root.upper1 - origin)));
  }
  return max(farthest.x, max(farthest.y, farthest.z));
}

/// A node of the array, the top level's first.
BvhNode readNode(const BvhNodeRef nodes, const uint index) {
  const u64vec2 pair0 = nodes.pairs[4u * index];
  const u64vec2 pair1 = nodes.pairs[4u * index + 1u];
  const u64vec2 pair2 = nodes.pairs[4u * index + 2u];
  const u64vec2 pair3 = nodes.pairs[4u * index + 3u];
  const uvec4 a = uvec4(unpackUint2x32(pair0.x), unpackUint2x32(pair0.y));
  const uvec4 b = uvec4(unpackUint2x32(pair1.x), unpackUint2x32(pair1.y));
  const uvec4 c = uvec4(unpackUint2x32(pair2.x), unpackUint2x32(pair2.y));
  const uvec4 d = uvec4(unpackUint2x32(pair3.x), unpackUint2x32(pair3.y));
  return BvhNode(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w,
                 uintBitsToFloat(d.xyz), d.w);
}

/// The body of traceClosest and traceOccluded. `anyHit` is a literal at both calls, so each keeps only its own half.
///
/// @param ignored  instance of a sphere light that the ray does not see, or kInvalidIndex
///
/// One loop over nodes, instances and triangles. It ends: every turn either descends the tree, consumes a leaf item or
/// takes an entry off the stack, and entries come from descending alone.
RayHit traverse(const SceneRef scene, const vec3 origin, const vec3 direction, const float tMin, const float tMax,
                const AlphaKey key, const uint ignored, const bool anyHit) {
  RayHit best = RayHit(tMax, kInvalidIndex, kInvalidIndex, vec2(0.0), false, false);
  if (scene.view.instanceCount == 0u) return best;
  // Locals: the compiler of a CPU driver does not hoist loads out of the loop.
  BvhNodeRef nodes = BvhNodeRef(scene.view.nodes);
  BvhTriangleRef triangles = BvhTriangleRef(scene.view.triangles);
  InstanceRef instances = InstanceRef(scene.view.instances);

  uint stackWork[kTraversalStackSize];
  float stackDistance[kTraversalStackSize];
  uint stackSize = 0u;
  uint instanceFloor = 0u; // stack size at which the current instance is done
  uint instance = kTopLevel;
  const BoxRay worldRay = makeBoxRay(origin, direction, reachOf(readNode(nodes, 0u), origin));
  BoxRay boxRay = worldRay;
  TriangleRay triangleRay = TriangleRay(vec3(0.0), vec3(0.0), vec3(0.0), 0u);
  uint work = 0u; // the root

  while (true) {
    const uint index = work & kWorkIndexMask;
    const uint count = work >> kWorkCountShift;
    if (count == 0u) {
      const BvhNode node = readNode(nodes, index);
      const float t0 = enterBox(boxRay, node.lower0, node.upper0, tMin, best.t);
      const float t1 = enterBox(boxRay, node.lower1, node.upper1, tMin, best.t);
      const uint work0 = node.child0 | node.count0 << kWorkCountShift;
      const uint work1 = node.child1 | node.count1 << kWorkCountShift;
      const bool first1 = t1 != kBoxMissed && (t0 == kBoxMissed || t1 < t0);
      work = first1 ? work1 : work0;
      if (t0 != kBoxMissed && t1 != kBoxMissed) {
        if (stackSize < kTraversalStackSize) {
          stackWork[stackSize] = first1 ? work0 : work1;
          stackDistance[stackSize] = max(t0, t1);
          ++stackSize;
        } else {
          best.stackOverflow = true;
        }
      } else if (t0 == t1) {
        work = kNoWork;
      }
    } else if (instance == kTopLevel) {
      if (count > 1u) {
        if (stackSize < kTraversalStackSize) {
          stackWork[stackSize] = (index + 1u) | (count - 1u) << kWorkCountShift;
          stackDistance[stackSize] = tMin;
          ++stackSize;
        } else {
          best.stackOverflow = true;
        }
      }
      if (kHasSphereLights && (instances.items[index].flags & kInstanceSphere) != 0u) {
        const vec4 sphere = instances.items[index].worldFromObject[0];
        const SphereHit hit = intersectSphere(origin, direction, sphere.xyz, sphere.w, tMin);
        if (hit.found && index != ignored && isCloser(hit.t, index, kInvalidIndex, best)) {
          best = RayHit(hit.t, index, kInvalidIndex, vec2(0.0), true, best.stackOverflow);
          if (anyHit) return best;
        }
        work = kNoWork;
      } else {
        instance = index;
        instanceFloor = stackSize;
        const Affine objectFromWorld = objectFromWorldOf(instances, instance);
        const vec3 objectOrigin = transformPoint(objectFromWorld, origin);
        const vec3 objectDirection = transformVector(objectFromWorld, direction);
        work = instances.items[instance].rootNode;
        boxRay = makeBoxRay(objectOrigin, objectDirection, reachOf(readNode(nodes, work), objectOrigin));
        triangleRay = makeTriangleRay(objectOrigin, objectDirection);
      }
    } else {
      const BvhTriangle triangle = triangles.items[index];
      const TriangleHit hit = intersectTriangle(triangleRay, triangle.v0, triangle.v1, triangle.v2);
      if (hit.found && hit.t >= tMin && isCloser(hit.t, instance, index, best)) {
        bool accepted = true;
        if (kHasAlpha) {
          if ((triangle.flags & kTriangleHasAlpha) != 0u) {
            accepted =
                passesAlphaTest(scene, key, instance, triangle.geometry, triangle.primitiveIndex, hit.barycentrics);
          }
        }
        if (accepted) {
          best = RayHit(hit.t, instance, index, hit.barycentrics, true, best.stackOverflow);
          if (anyHit) return best;
        }
      }
      work = count > 1u ? (index + 1u) | (count - 1u) << kWorkCountShift : kNoWork;
    }

    while (work == kNoWork) {
      if (stackSize == instanceFloor) {
        if (instance == kTopLevel) return best;
        instance = kTopLevel;
        instanceFloor = 0u;
        boxRay = worldRay;
      } else {
        --stackSize;
        if (stackDistance[stackSize] <= best.t) work = stackWork[stackSize];
      }
    }
  }
  return best;
}

/// The closest surface with tMin <= t < tMax that the alpha test accepts.
///
/// @param direction  any length; t counts in units of it, in every instance
/// @param tMin       >= 0
/// @param tMax       kRayInfinity where nothing bounds the ray
/// @param ignored    instance of a sphere light that the ray does not see, or kInvalidIndex
RayHit traceClosest(const SceneRef scene, const vec3 origin, const vec3 direction, const float tMin, const float tMax,
                    const AlphaKey key, const uint ignored) {
  return traverse(scene, origin, direction, tMin, tMax, key, ignored, false);
}

/// Whether any surface that the alpha test accepts has tMin <= t < tMax.
///
/// @param ignored  instance of the sphere light that the ray ends on, or kInvalidIndex
bool traceOccluded(const SceneRef scene, const vec3 origin, const vec3 direction, const float tMin, const float tMax,
                   const AlphaKey key, const uint ignored, out bool stackOverflow) {
  const RayHit hit = traverse(scene, origin, direction, tMin, tMax, key, ignored, true);
  stackOverflow = hit.stackOverflow;
  return hit.found;
}

#endif
