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

// Piecewise-constant density over an equirectangular map of width x height texels, as cumulative sums in [0, 1]:
// marginal over rows has height + 1 values, conditional over columns height * (width + 1).
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
