// Lights as the device reads them. Light indices run: emissive triangles of every instance, lights of
// KHR_lights_punctual (suns first), environment.
#ifndef ISOPHOTE_SHARED_LIGHT_TYPES_H
#define ISOPHOTE_SHARED_LIGHT_TYPES_H

#include "glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

// One bin of Walker's alias method. `pmf` is the probability of the light with this entry's own index.
struct AliasEntry {
  float threshold; // keep the own index where u < threshold, else take `alias`
  uint alias;
  float pmf;
};

// A cluster of lights in the light tree, or one light. Lengths and positions are SceneView.lightTreeScale times the
// world's, relative to its origin; intensities are shares of their sum over all lights with a place.
struct LightTreeNode {
  vec3 center;     // of a box that holds the lights
  vec3 extent;     // half its size; x kLightTreeFixed: what is below has no place, or none that counts here
  float intensity; // largest, summed over the lights; where fixed, its weight
  uint axis;       // of the cone of normals: octahedral, two signed normalised 16-bit numbers
  uint cosines;    // of thetaO and thetaE (accel/light_cone.hpp), two signed normalised 16-bit numbers
  uint child;      // first of two neighbouring nodes; with kLightTreeLeaf a light; kLightTreeTwoSided apart
};
ISOPHOTE_CONST uint kLightTreeLeaf = 0x80000000u;
ISOPHOTE_CONST uint kLightTreeTwoSided = 0x40000000u; // light leaves about -axis as well
ISOPHOTE_CONST uint kLightTreeIndexMask = 0x3fffffffu;
ISOPHOTE_CONST uint kLightTreeMaxLights = 0x1fffffffu;
ISOPHOTE_CONST uint kLightTreeMaxDepth = 31u;
ISOPHOTE_CONST float kLightTreeFixed = 3.402823466e38f;
ISOPHOTE_CONST uint kNoLightTrail = 0xffffffffu; // of lights that are not in the tree: 32 steps, one too many

// The point that light is chosen for.
struct LightReceiver {
  vec3 p;  // relative to SceneView.worldOrigin
  vec3 ns; // unit; only light with dot(ns, wi) > 0 counts. 0: light from all around
};

struct EmissiveTriangle {
  uint instance;
  uint triangle; // index of its BvhTriangle
};

ISOPHOTE_CONST uint kLightPoint = 0u;
ISOPHOTE_CONST uint kLightSpot = 1u;
ISOPHOTE_CONST uint kLightDirectional = 2u;

// Without a size a light is a delta light. Point and spot lights with one are spheres, directional ones are disks at
// infinity: suns.
struct PunctualLightRecord {
  vec3 position; // relative to SceneView.worldOrigin
  uint kind;
  vec3 direction; // unit, the way the light travels
  float range;    // 0: unlimited
  vec3 intensity; // W/sr, of directional lights W/m^2; of lights with a size radiance
  float cosInner;
  float cosOuter;
  float size;    // sphere: radius; sun: 1 - cos of its angular radius; 0: none
  uint instance; // sphere: its InstanceRecord
};

// An equirectangular map of width x height texels, and the probabilities of its cells as cumulative sums in [0, 1].
// Cell (column, row) lies between the centers of texel columns column and column + 1, periodic, and of texel rows row -
// 1 and row; the first and the last row of cells reach to the poles. marginal over rows of cells has height + 2 values,
// conditional over columns (height + 1) * (width + 1).
struct EnvironmentRecord {
  Address pixels; // vec3 radiance, row 0 up (+y), intensity applied
  Address marginal;
  Address conditional;
  uint width;
  uint height;
  float cosRotation; // rotation about +y from map to world
  float sinRotation;
};

ISOPHOTE_SHARED_END

#endif
