// Glass whose index depends on the color: Cauchy's formula through the Abbe number, as KHR_materials_dispersion has it.
#ifndef ISOPHOTE_BSDF_DISPERSION_GLSL
#define ISOPHOTE_BSDF_DISPERSION_GLSL

#include "shared/material_types.h"

/// Whether the index differs by color and matters: thin walls do not bend light.
bool isDispersive(const MaterialRecord record) {
  return record.dispersion > 0.0 && record.thickness > 0.0 && record.ior > 1.0 && record.transmission > 0.0;
}

/// Returns the index of one color channel, 0 red to 2 blue; the nominal one is green's.
///
/// @return at least 1: large dispersions would take red below the index of air
float channelIor(const MaterialRecord record, const uint channel) {
  const float halfSpread = (record.ior - 1.0) * 0.025 * record.dispersion;
  return max(record.ior + halfSpread * (float(channel) - 1.0), 1.0);
}

#endif
