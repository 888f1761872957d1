// Which light: Walker's alias method in integers.
#ifndef ISOPHOTE_LIGHT_ALIAS_GLSL
#define ISOPHOTE_LIGHT_ALIAS_GLSL

#include "light/light_choice_result.glsl"
#include "shared/buffers.glsl"

/// Chooses a light with the probabilities of the alias table.
///
/// The bin is the integer part of bits.x * count; its fraction continues bits.y, so thresholds are met to 2^-24 of
/// their own value however small they are and however many lights there are. Source: Walker 1977, "An Efficient Method
/// for Generating Discrete Random Variables"; Vose 1991.
/// @param bits  two uniform 32-bit fractions
LightChoice chooseByAlias(const SceneRef scene, uvec2 bits) {
  AliasRef table = AliasRef(scene.view.lightAlias);
  uint bin;
  uint fraction;
  umulExtended(bits.x, scene.view.lightCount, bin, fraction);
  const float u = float(bits.y) * 2.3283064365386963e-10 + float(fraction) * 5.421010862427522e-20; // 2^-32, 2^-64
  const uint index = u < table.items[bin].threshold ? bin : table.items[bin].alias;
  return LightChoice(index, table.items[index].pmf);
}

/// Probability with which chooseByAlias chooses light `index` < lightCount.
float aliasPmf(const SceneRef scene, uint index) { return AliasRef(scene.view.lightAlias).items[index].pmf; }

#endif
