// Which light a receiver samples: the setting light-selection.
#ifndef ISOPHOTE_LIGHT_LIGHT_CHOICE_GLSL
#define ISOPHOTE_LIGHT_LIGHT_CHOICE_GLSL

#include "light/alias.glsl"
#include "light/light_tree.glsl"
#include "shared/constants.glsl"

const uint kSelectUniform = 0u; // values of kLightSelection, as isophote::LightSelection
const uint kSelectTree = 2u;

const bool kMayChooseByTree = kHasLightTree && kLightSelection == kSelectTree;

/// Whether the choice depends on the receiver. The tree is absent under an all-features kernel.
bool hasTree(const SceneRef scene) { return scene.view.lightTree != 0ul; }

/// Chooses one of the scene's lights, of which there is at least one. @param bits  two uniform 32-bit fractions
LightChoice chooseLight(const SceneRef scene, const LightReceiver receiver, uvec2 bits) {
  if (kMayChooseByTree && hasTree(scene)) return chooseFromLightTree(scene, receiver, bits);
  if (kLightSelection == kSelectUniform) {
    uint index;
    uint fraction;
    umulExtended(bits.x, scene.view.lightCount, index, fraction);
    return LightChoice(index, 1.0 / float(scene.view.lightCount));
  }
  return chooseByAlias(scene, bits);
}

/// Probability with which chooseLight chooses light `index`; 0 where the scene has no such light.
float lightPmf(const SceneRef scene, const LightReceiver receiver, uint index) {
  if (index >= scene.view.lightCount) return 0.0;
  if (kMayChooseByTree && hasTree(scene)) return lightTreePmf(scene, receiver, index);
  if (kLightSelection == kSelectUniform) return 1.0 / float(scene.view.lightCount);
  return aliasPmf(scene, index);
}

#endif
