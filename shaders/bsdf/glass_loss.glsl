// What one scattering by rough glass loses between its facets, read from the tables of
// engine/src/upload/glass_loss.cpp. Layout: shared/bsdf_constants.h.
#ifndef ISOPHOTE_BSDF_GLASS_LOSS_GLSL
#define ISOPHOTE_BSDF_GLASS_LOSS_GLSL

#include "shared/bsdf_constants.h"
#include "shared/buffers.glsl"

/// Returns 1 - reflected - transmitted of light that meets the surface at cosine mu, bilinear in sqrt(mu) and
/// roughness.
///
/// @param halfTable     where the half table of the side that the light comes from begins
/// @param specular KHR_materials_specular's factor: the loss is linear in it
/// Accuracy: see docs/bsdf.md, measured in tests/unit/glass_loss_test.cpp.
float glassLoss(const SceneRef scene, const uint halfTable, const float mu, const float alpha, const float specular) {
  const float column = sqrt(clamp(mu, 0.0, 1.0)) * float(kGlassLossMuCount - 1u);
  const float row = sqrt(clamp(alpha, 0.0, 1.0)) * float(kGlassLossRoughnessCount - 1u);
  const uint c = min(uint(column), kGlassLossMuCount - 2u);
  const uint r = min(uint(row), kGlassLossRoughnessCount - 2u);
  Vec2Ref table = Vec2Ref(scene.view.glassLoss);
  const uint first = halfTable + r * kGlassLossMuCount + c;
  const uint second = first + kGlassLossMuCount;
  const float t = column - float(c);
  const vec2 loss = mix(mix(table.items[first], table.items[first + 1u], t),
                        mix(table.items[second], table.items[second + 1u], t), row - float(r));
  return mix(loss.y, loss.x, specular);
}

/// Returns the cosine-weighted mean of glassLoss over the hemisphere.
float glassMeanLoss(const SceneRef scene, const uint halfTable, const float alpha, const float specular) {
  const float row = sqrt(clamp(alpha, 0.0, 1.0)) * float(kGlassLossRoughnessCount - 1u);
  const uint r = min(uint(row), kGlassLossRoughnessCount - 2u);
  Vec2Ref table = Vec2Ref(scene.view.glassLoss);
  const uint first = halfTable + kGlassLossMeans + r;
  const vec2 loss = mix(table.items[first], table.items[first + 1u], row - float(r));
  return mix(loss.y, loss.x, specular);
}

#endif
