// Constants of the surface scattering model that host and device must agree on.
#ifndef ISOPHOTE_SHARED_BSDF_CONSTANTS_H
#define ISOPHOTE_SHARED_BSDF_CONSTANTS_H

#include "glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

// Below this alpha the specular lobe is a delta mirror. The sun's disk, the smallest strong light there is, has a
// radius of 4.65e-3: seen in GGX of this width it is dimmer by 0.05%, at 1e-3 it was by 16% (docs/envelope,
// roughness-sun). Single precision knows the microfacet normal's tilt to 1e-7, 0.2% of the width, which is noise.
ISOPHOTE_CONST float kMirrorAlpha = 5e-5f;

// The narrow side of anisotropic facets, and the least width that textbook techniques of sampling are given.
ISOPHOTE_CONST float kNarrowestAlpha = 1e-3f;

// The diffuse lobe divides by 1 - (mean albedo of its coat), never by less than this. It matters only for dielectrics
// that reflect nearly everything at every angle (ior 0 or huge), whose diffuse lobe it darkens: energy can be lost, not
// gained.
ISOPHOTE_CONST float kMinCoatTransmission = 1e-3f;

// Table of the albedo integrals (A, B) of isotropic facets, see bsdf/facet_albedo.glsl. Column c stands for mu = (c /
// (kFacetAlbedoMuCount - 1))^2, row r for roughness = sqrt(alpha) = r / (kFacetAlbedoRoughnessCount - 1): item r *
// kFacetAlbedoMuCount + c. Behind the rows follow kFacetAlbedoRoughnessCount cosine-weighted means over mu, one a row.
ISOPHOTE_CONST uint kFacetAlbedoMuCount = 64u;
ISOPHOTE_CONST uint kFacetAlbedoRoughnessCount = 64u;
ISOPHOTE_CONST uint kFacetAlbedoMeans = kFacetAlbedoMuCount * kFacetAlbedoRoughnessCount;
ISOPHOTE_CONST uint kFacetAlbedoSize = kFacetAlbedoMeans + kFacetAlbedoRoughnessCount;

// Tables of (A, B) for anisotropic facets, see bsdf/anisotropic_albedo.glsl; one for each kind of surface, behind each
// other. Item 0 is the range of roughness, item 1 that of strength; then follow planes of one roughness and strength,
// kAnisotropyRoughnessCount (or 1 where the range is a point) a strength, kAnisotropyStrengthCount (or 1) strengths. A
// plane has kAnisotropyAzimuthCount rows of kAnisotropyMuCount columns and the mean over the hemisphere.
ISOPHOTE_CONST uint kAnisotropyMuCount = 96u;
ISOPHOTE_CONST uint kAnisotropyAzimuthCount = 12u;
ISOPHOTE_CONST uint kAnisotropyRoughnessCount = 16u;
ISOPHOTE_CONST uint kAnisotropyStrengthCount = 12u;
ISOPHOTE_CONST uint kAnisotropyHeader = 2u;
ISOPHOTE_CONST uint kAnisotropyMean = kAnisotropyMuCount * kAnisotropyAzimuthCount;
ISOPHOTE_CONST uint kAnisotropyPlane = kAnisotropyMean + 1u;

// Normal reflectance of the clearcoat, index 1.5 (KHR_materials_clearcoat).
ISOPHOTE_CONST float kClearcoatF0 = 0.04f;

// Fibres do not stand up straighter than this (roughness 0.07): all that the sheen's lobe still does is a hairline at
// the horizon, too thin for its table.
ISOPHOTE_CONST float kMinSheenAlpha = 5e-3f;

// Table of a layer over the base, see bsdf/layer.glsl: floats. Nodes of mu as in the table above, c; r stands for the
// layer's row r / (kLayerRoughnessCount - 1), which is a clearcoat's roughness and sheenRow of a sheen's; b for the
// base's roughness b / (kLayerBaseCount - 1).
ISOPHOTE_CONST uint kLayerMuCount = 64u;
ISOPHOTE_CONST uint kLayerRoughnessCount = 32u;
ISOPHOTE_CONST uint kLayerBaseCount = 16u;
ISOPHOTE_CONST uint kLayerAlbedo = 0u;                                  // [r][c] what the layer reflects
ISOPHOTE_CONST uint kLayerScale = kLayerRoughnessCount * kLayerMuCount; // [r][c] factor of the lobe at each direction
ISOPHOTE_CONST uint kLayerMean = kLayerScale + kLayerRoughnessCount * kLayerMuCount; // [r] cosine-weighted mean albedo
ISOPHOTE_CONST uint kLayerNarrow = kLayerMean + kLayerRoughnessCount; // [r][b][c] coupling with a microfacet base
ISOPHOTE_CONST uint kLayerThrough =
    kLayerNarrow + kLayerRoughnessCount * kLayerBaseCount * kLayerMuCount; // [2][r][b][c] of A, B what leaves the layer
ISOPHOTE_CONST uint kLayerThroughStride = kLayerRoughnessCount * kLayerBaseCount * kLayerMuCount;
ISOPHOTE_CONST uint kLayerThroughMean = kLayerThrough + 2u * kLayerThroughStride; // [r][b][2] mean A, B that leaves
ISOPHOTE_CONST uint kLayerTableSize = kLayerThroughMean + 2u * kLayerRoughnessCount * kLayerBaseCount;

// Table of a sheen under a clearcoat, see bsdf/coated_sheen.glsl: items [r][q][b] of kLayerMuCount columns [c] and a
// mean. r is the sheen's row, q stands for the coat's roughness q / (kCoatedSheenCoatCount - 1), b and c as above.
ISOPHOTE_CONST uint kCoatedSheenCoatCount = 16u;
ISOPHOTE_CONST uint kCoatedSheenStride = kLayerMuCount + 1u;
ISOPHOTE_CONST uint kCoatedSheenSize =
    kLayerRoughnessCount * kCoatedSheenCoatCount * kLayerBaseCount * kCoatedSheenStride;

// Tables of what dielectric facets under a film reflect, see bsdf/film_albedo.glsl; one for each kind of surface,
// behind each other. Item 0 is the range of thickness and the count of its nodes, item 1 that of roughness; then follow
// planes of one thickness and roughness, roughnesses first, each kFilmMuCount columns of sqrt(mu) and the mean over the
// hemisphere.
ISOPHOTE_CONST uint kFilmMuCount = 64u;
ISOPHOTE_CONST uint kFilmPlane = kFilmMuCount + 1u;
ISOPHOTE_CONST uint kFilmHeader = 2u;
ISOPHOTE_CONST uint kFilmRoughnessCount = 32u; // where a texture gives it, else 1
ISOPHOTE_CONST uint kFilmThicknessLimit = 256u;
ISOPHOTE_CONST float kFilmPathStep = 20.0f; // nm of optical path between two thicknesses, where the limit allows

// Tables of what one scattering by rough glass loses between its facets, see bsdf/glass_loss.glsl; one for each index,
// behind each other. Each has two halves, for light that comes from the air and from the glass; each half
// kGlassLossRoughnessCount rows of kGlassLossMuCount columns, spaced as those above, and then the means, one a row.
ISOPHOTE_CONST uint kGlassLossMuCount = 64u;
ISOPHOTE_CONST uint kGlassLossRoughnessCount = 32u;
ISOPHOTE_CONST uint kGlassLossMeans = kGlassLossMuCount * kGlassLossRoughnessCount;
ISOPHOTE_CONST uint kGlassLossHalf = kGlassLossMeans + kGlassLossRoughnessCount;

ISOPHOTE_SHARED_END

#endif
