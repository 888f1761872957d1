// Constants of the surface scattering model that host and device must agree on.
#ifndef ISOPHOTE_SHARED_BSDF_CONSTANTS_H
#define ISOPHOTE_SHARED_BSDF_CONSTANTS_H

#include "glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

// Below this alpha the specular lobe is a delta mirror: GGX at 1e-3 spreads light by about 0.1 degree already, and
// smaller values leave single precision too few digits for the microfacet normal's tilt.
ISOPHOTE_CONST float kMirrorAlpha = 1e-3f;

// The diffuse lobe divides by 1 - (mean albedo of its coat), never by less than this. It matters only for dielectrics
// that reflect nearly everything at every angle (ior 0 or huge), whose diffuse lobe it darkens: energy can be lost, not
// gained.
ISOPHOTE_CONST float kMinCoatTransmission = 1e-3f;

// Table of GGX albedo integrals (A, B), see bsdf/ggx_albedo.glsl. Column c stands for mu = (c / (kGgxAlbedoMuCount -
// 1))^2, row r for roughness = sqrt(alpha) = r / (kGgxAlbedoRoughnessCount - 1): item r * kGgxAlbedoMuCount + c. Behind
// the rows follow kGgxAlbedoRoughnessCount cosine-weighted means over mu, one a row.
ISOPHOTE_CONST uint kGgxAlbedoMuCount = 64u;
ISOPHOTE_CONST uint kGgxAlbedoRoughnessCount = 64u;
ISOPHOTE_CONST uint kGgxAlbedoMeans = kGgxAlbedoMuCount * kGgxAlbedoRoughnessCount;

// Tables of what one scattering by rough glass loses between its facets, see bsdf/glass_loss.glsl; one for each index,
// behind each other. Each has two halves, for light that comes from the air and from the glass; each half
// kGlassLossRoughnessCount rows of kGlassLossMuCount columns, spaced as those above, and then the means, one a row.
ISOPHOTE_CONST uint kGlassLossMuCount = 64u;
ISOPHOTE_CONST uint kGlassLossRoughnessCount = 32u;
ISOPHOTE_CONST uint kGlassLossMeans = kGlassLossMuCount * kGlassLossRoughnessCount;
ISOPHOTE_CONST uint kGlassLossHalf = kGlassLossMeans + kGlassLossRoughnessCount;

ISOPHOTE_SHARED_END

#endif
