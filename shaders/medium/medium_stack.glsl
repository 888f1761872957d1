// Which medium a point is in, and what crossing a boundary changes.
//
// Source: Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images", JGT 7(2): where closed meshes
// overlap, the one of the highest priority fills the place, and the others' faces inside it do nothing.
#ifndef ISOPHOTE_MEDIUM_MEDIUM_STACK_GLSL
#define ISOPHOTE_MEDIUM_MEDIUM_STACK_GLSL

#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require // of shared/path_types.h

#include "bsdf/dispersion.glsl"
#include "medium/homogeneous.glsl"
#include "shared/buffers.glsl"
#include "shared/geometry_types.h"
#include "shared/path_types.h"

MediumStack noMedia() { return MediumStack(uint[](kInvalidIndex, kInvalidIndex, kInvalidIndex, kInvalidIndex)); }

/// The material whose medium fills the place: of the highest priority, and of equal ones the last entered;
/// kInvalidIndex: none.
uint currentMedium(const SceneRef scene, const MediumStack stack) {
  uint found = kInvalidIndex;
  float highest = 0.0;
  for (uint i = 0u; i < kMediumStackSize; ++i) {
    const uint material = stack.materials[i];
    if (material == kInvalidIndex) break;
    const float priority = MaterialRef(scene.view.materials).items[material].mediumPriority;
    if (found == kInvalidIndex || priority >= highest) {
      found = material;
      highest = priority;
    }
  }
  return found;
}

/// The stack after entering `material`; unchanged where it is full.
MediumStack enterMedium(MediumStack stack, const uint material) {
  for (uint i = 0u; i < kMediumStackSize; ++i) {
    if (stack.materials[i] != kInvalidIndex) continue;
    stack.materials[i] = material;
    break;
  }
  return stack;
}

bool isFull(const MediumStack stack) { return stack.materials[kMediumStackSize - 1u] != kInvalidIndex; }

bool contains(const MediumStack stack, const uint material) {
  bool found = false;
  for (uint i = 0u; i < kMediumStackSize; ++i) found = found || stack.materials[i] == material;
  return found;
}

/// The stack without the last entry that is `material`.
MediumStack leaveMedium(MediumStack stack, const uint material) {
  uint last = kMediumStackSize;
  for (uint i = 0u; i < kMediumStackSize; ++i) {
    if (stack.materials[i] == material) last = i;
  }
  for (uint i = 0u; i < kMediumStackSize; ++i) {
    if (i < last) continue;
    stack.materials[i] = i + 1u < kMediumStackSize ? stack.materials[i + 1u] : kInvalidIndex;
  }
  return stack;
}

/// A boundary as a path meets it.
struct MediumCrossing {
  uint before;        // the materials whose media lie on the path's side and beyond; kInvalidIndex: none
  uint beyond;        // equal: the face lies inside another medium and does nothing
  MediumStack here;   // the media on the path's side
  MediumStack across; // the media beyond
};

/// A surface that bounds no medium.
MediumCrossing noCrossing(const SceneRef scene, const MediumStack stack) {
  const uint material = currentMedium(scene, stack);
  return MediumCrossing(material, material, stack, stack);
}

/// @param stack     on the path's side
/// @param entering  the path meets the front of the face
MediumCrossing crossBoundary(const SceneRef scene, const MediumStack stack, const uint material, const bool entering) {
  MediumCrossing crossing;
  crossing.before = currentMedium(scene, stack);
  crossing.here = stack;
  crossing.across = entering ? enterMedium(stack, material) : leaveMedium(stack, material);
  crossing.beyond = currentMedium(scene, crossing.across);
  // Left but never entered, through a hole in the mesh or where the camera's media are unknown: it was there all along.
  if (!entering && !contains(stack, material)) crossing.before = material;
  return crossing;
}

/// Whether light can enter a material by refraction. What it enters by diffuse transmission alone has no index.
bool refracts(const SceneRef scene, const uint material) {
  return !kHasDiffuseTransmission || MaterialRef(scene.view.materials).items[material].transmission > 0.0;
}

/// Index of refraction of a material's medium; 1 of none, of those that nothing enters (index 0, for infinity), and
/// where nothing refracts.
float mediumIor(const SceneRef scene, const uint material, const uint channel) {
  if (material == kInvalidIndex || !refracts(scene, material)) return 1.0;
  return max(materialIor(MaterialRef(scene.view.materials).items[material], channel), 1.0);
}

/// Index beyond a boundary over the index before it.
float etaAcross(const SceneRef scene, const MediumCrossing crossing, const uint channel) {
  return mediumIor(scene, crossing.beyond, channel) / mediumIor(scene, crossing.before, channel);
}

/// Whether a path goes straight on through a boundary, unchanged: it lies inside another medium, or it is clear and
/// the indices are equal.
bool isInvisible(const SceneRef scene, const MediumCrossing crossing, const uint material) {
  if (crossing.before == crossing.beyond) return true;
  const uint flags = MaterialRef(scene.view.materials).items[material].flags;
  return (flags & kMaterialClear) != 0u && etaAcross(scene, crossing, 1u) == 1.0;
}

bool isVolumeBoundary(const SceneRef scene, const uint material) {
  return (MaterialRef(scene.view.materials).items[material].flags & kMaterialVolume) != 0u;
}

/// The medium of a material; a vacuum for kInvalidIndex.
Medium mediumOf(const SceneRef scene, const uint material) {
  if (material == kInvalidIndex) return Medium(vec3(0.0), vec3(0.0), 0.0);
  MaterialRef materials = MaterialRef(scene.view.materials);
  return Medium(materials.items[material].extinction, materials.items[material].scatteringAlbedo,
                materials.items[material].scatterAnisotropy);
}

bool scatters(const Medium medium) { return any(greaterThan(medium.extinction * medium.albedo, vec3(0.0))); }

#endif
