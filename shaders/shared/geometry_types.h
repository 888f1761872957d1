// Geometry as the device reads it: BVH, triangles, instances, per-vertex attributes. Scalar layout.
#ifndef ISOPHOTE_SHARED_GEOMETRY_TYPES_H
#define ISOPHOTE_SHARED_GEOMETRY_TYPES_H

#include "glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

ISOPHOTE_CONST uint kInvalidIndex = 0xffffffffu;
ISOPHOTE_CONST uint kUvSetCount = 4u;
ISOPHOTE_CONST float kRayInfinity = 3.402823466e38f; // tMax of a ray that nothing bounds
// No BVH is deeper than this many inner nodes from root to leaf; the traversal stack holds both levels.
ISOPHOTE_CONST uint kMaxBvhDepth = 32u;

// Both children's boxes in the parent. count 0: child is an inner node's index; else child is the first of `count`
// leaf items (BvhTriangle in a mesh BVH, Instance in the top level). An absent child has lower > upper.
// Indices are absolute in their arrays.
struct BvhNode {
  vec3 lower0;
  uint child0;
  vec3 upper0;
  uint count0;
  vec3 lower1;
  uint child1;
  vec3 upper1;
  uint count1;
};

ISOPHOTE_CONST uint kTriangleHasAlpha = 1u; // mask or blend: candidates call the alpha test
ISOPHOTE_CONST uint kTriangleEmissive = 2u;

// In leaf order. Object space.
struct BvhTriangle {
  vec3 v0;
  uint primitiveIndex; // triangle number within its geometry
  vec3 v1;
  uint geometry; // index into the Geometry array
  vec3 v2;
  uint flags;
};

// Rows of two affine 3x4 maps. World space is relative to SceneView.worldOrigin.
// kInstanceSphere: a sphere light in world space; worldFromObject[0] is its center and radius, rootNode and mesh are
// kInvalidIndex.
struct InstanceRecord {
  vec4 worldFromObject[3];
  vec4 objectFromWorld[3];
  uint rootNode;
  uint firstEmitter; // light index of this instance's first emissive triangle, or of the sphere; or kInvalidIndex
  uint mesh;
  uint flags;
};
ISOPHOTE_CONST uint kInstanceMirrored = 1u; // the map turns winding over
ISOPHOTE_CONST uint kInstanceSphere = 2u;

// One primitive of a mesh. Offsets count elements of the attribute arrays; kInvalidIndex: attribute absent.
struct Geometry {
  uint firstIndex; // into indices: 3 per triangle, relative to this geometry's attributes
  uint firstNormal;
  uint firstTangent;
  uint firstColor;
  uint firstUv[4];
  uint material;
  uint firstEmissive; // emissive triangles of the mesh before this geometry, or kInvalidIndex
};

ISOPHOTE_SHARED_END

#endif
