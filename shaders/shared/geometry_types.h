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

// Up to eight children, their boxes in the cells of a frame of the node's own: a grid of 256 cells an axis whose size
// is a power of two. The frame is that of Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs
// Through Compressed Wide BVHs". A slot is empty, an inner node, or a leaf of one to three items (BvhTriangle in a mesh
// BVH, InstanceRecord in the top level). Slot 4 a + 2 b + c lies towards the upper end of z where a, y where b, x where
// c.
ISOPHOTE_CONST uint kBvhWidth = 8u;
ISOPHOTE_CONST uint kBvhItemsPerSlot = 3u;
ISOPHOTE_CONST uint kBvhInnerShift = 24u;
ISOPHOTE_CONST float kBvhFrameCells = 256.0;
ISOPHOTE_CONST uint kBvhNodeBytes = 80u;
ISOPHOTE_CONST uint kBvhBoundsOffset = 32u; // of `lower`

struct BvhNode {
  vec3 origin;     // lower corner of the frame
  uint exponents;  // of the frame's size on x, y, z, a byte each, biased by 127
  uint contents;   // bits 3 s to 3 s + 2: the items of slot s; bit 24 + s: slot s is an inner node
  uint firstChild; // inner nodes and items follow one another by slot; absolute in their arrays
  uint firstItem;
  uint unused;
  uint lower[6]; // first cell of each box, a byte a slot: two words for x, two for y, two for z
  uint upper[6]; // its far side, likewise
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
  uint mesh;         // a group of the Scene's meshes
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
