// The two-level BVH, walked by the kernel itself. Included by geometry/traverse.glsl alone.
#ifndef ISOPHOTE_GEOMETRY_TRAVERSE_BVH_GLSL
#define ISOPHOTE_GEOMETRY_TRAVERSE_BVH_GLSL

#include "geometry/alpha_test.glsl"
#include "geometry/instance_map.glsl"
#include "geometry/ray_node.glsl"
#include "geometry/ray_sphere.glsl"
#include "geometry/ray_triangle.glsl"

// What a ray cost, for tests; the product's kernels are compiled without.
#ifdef ISOPHOTE_COUNT_STEPS
struct RaySteps {
  uint turns; // of the loop
  uint nodes;
  uint triangles;
  uint instances;
} raySteps;
#define COUNT_STEP(member) ++raySteps.member
#else
#define COUNT_STEP(member)
#endif

// A macro, because a function would copy the whole stack in and out.
#define PUSH_GROUP(node, bits)                                                                                         \
  if (stackSize < kTraversalStackSize) {                                                                               \
    stackFirst[stackSize] = node;                                                                                      \
    stackGroup[stackSize] = bits;                                                                                      \
    ++stackSize;                                                                                                       \
  } else {                                                                                                             \
    best.stackOverflow = true;                                                                                         \
  }

// Inner children, or instances of a top-level leaf, that are still to be visited: two words. Children: where they
// begin; a bit for each in the highest byte, the first to visit highest; which slots are inner nodes in the lowest.
// Instances: the node; their bits in BvhNode.contents, the highest byte 0.

// A path through one level leaves at most one group per node; the rest of a top-level leaf is one more.
const uint kTraversalStackSize = 2u * kMaxBvhDepth + 1u;

const uint kTopLevel = kInvalidIndex; // in place of an instance

// Equal distances go to the smaller (instance, triangle), so that the order of visits does not matter.
bool isCloser(const float t, const uint instance, const uint triangle, const RayHit best) {
  if (t != best.t || !best.found) return t < best.t;
  return instance < best.instance || (instance == best.instance && triangle < best.triangle);
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
  const uint64_t nodes = scene.view.nodes;
  BvhTriangleRef triangles = BvhTriangleRef(scene.view.triangles);
  InstanceRef instances = InstanceRef(scene.view.instances);

  uint stackFirst[kTraversalStackSize];
  uint stackGroup[kTraversalStackSize];
  uint stackSize = 0u;
  uint instanceFloor = 0u; // stack size at which the current instance is done
  uint instance = kTopLevel;
  const NodeRay worldRay = makeNodeRay(origin, direction, readFrame(nodes, 0u));
  NodeRay nodeRay = worldRay;
  TriangleRay triangleRay = TriangleRay(vec3(0.0), vec3(0.0), vec3(0.0), 0u);
  uint first = 0u;
  uint group = rootGroup(nodeRay);
  uint items = 0u; // of the node last tested: those hit, all that it has, the first of them
  uint present = 0u;
  uint firstItem = 0u;
  uint itemNode = 0u;
  if (scene.view.instanceCount == 1u) { // no top level to walk
    group = 0u;
    items = 1u;
    present = 1u;
  }

  while (true) {
    COUNT_STEP(turns);
    if (items == 0u) {
      COUNT_STEP(nodes);
      const uint bit = findMSB(group);
      const uint slot = (bit - kBvhInnerShift) ^ nodeRay.order;
      group ^= 1u << bit;
      if (group >= kLowestChildBit) {
        PUSH_GROUP(first, group);
      }
      itemNode = first + bitCount(group & ((1u << slot) - 1u));
      const NodeHits hits = enterNode(nodes, itemNode, nodeRay, tMin, best.t);
      first = hits.firstChild;
      firstItem = hits.firstItem;
      group = hits.group;
      items = hits.items;
      present = hits.present;
    }
    if (items != 0u) {
      const uint bit = findMSB(items);
      items ^= 1u << bit;
      const uint index = firstItem + bitCount(present & ((1u << bit) - 1u));
      if (instance == kTopLevel) {
        if (group >= kLowestChildBit) {
          PUSH_GROUP(first, group);
        }
        if (items != 0u) {
          PUSH_GROUP(itemNode, items);
        }
        items = 0u;
        group = 0u;
        if (kHasSphereLights && (instances.items[index].flags & kInstanceSphere) != 0u) {
          const vec4 sphere = instances.items[index].worldFromObject[0];
          const SphereHit hit = intersectSphere(origin, direction, sphere.xyz, sphere.w, tMin);
          if (hit.found && index != ignored && isCloser(hit.t, index, kInvalidIndex, best)) {
            best = RayHit(hit.t, index, kInvalidIndex, vec2(0.0), true, best.stackOverflow);
            if (anyHit) return best;
          }
        } else {
          COUNT_STEP(instances);
          instance = index;
          instanceFloor = stackSize;
          const Affine objectFromWorld = objectFromWorldOf(instances, instance);
          const vec3 objectOrigin = transformPoint(objectFromWorld, origin);
          const vec3 objectDirection = transformVector(objectFromWorld, direction);
          first = instances.items[instance].rootNode;
          nodeRay = makeNodeRay(objectOrigin, objectDirection, readFrame(nodes, first));
          triangleRay = makeTriangleRay(objectOrigin, objectDirection);
          group = rootGroup(nodeRay);
        }
      } else {
        COUNT_STEP(triangles);
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
      }
    }

    while (items == 0u && group < kLowestChildBit) {
      if (stackSize == instanceFloor) {
        if (instance == kTopLevel) return best;
        instance = kTopLevel;
        instanceFloor = 0u;
        nodeRay = worldRay;
      } else {
        --stackSize;
        first = stackFirst[stackSize];
        group = stackGroup[stackSize];
        if (group < kLowestChildBit) {
          items = group;
          group = 0u;
          itemNode = first;
          const NodeContents contents = readContents(nodes, itemNode);
          present = contents.present;
          firstItem = contents.firstItem;
        }
      }
    }
  }
  return best;
}

#endif
