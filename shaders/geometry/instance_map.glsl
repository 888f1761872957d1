// The maps of an instance, read row by row: a whole InstanceRecord is seldom needed.
#ifndef ISOPHOTE_GEOMETRY_INSTANCE_MAP_GLSL
#define ISOPHOTE_GEOMETRY_INSTANCE_MAP_GLSL

#include "geometry/affine.glsl"
#include "shared/buffers.glsl"

Affine worldFromObjectOf(const InstanceRef instances, const uint instance) {
  return Affine(instances.items[instance].worldFromObject[0], instances.items[instance].worldFromObject[1],
                instances.items[instance].worldFromObject[2]);
}

Affine objectFromWorldOf(const InstanceRef instances, const uint instance) {
  return Affine(instances.items[instance].objectFromWorld[0], instances.items[instance].objectFromWorld[1],
                instances.items[instance].objectFromWorld[2]);
}

#endif
