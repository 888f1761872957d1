// The scattering of a surface: a clearcoat over a sheen over the base. Formulas: docs/bsdf-layers.md, "Layers".
//
// Directions are unit and in the local shading frame, z the shading normal on wo's side.
#ifndef ISOPHOTE_BSDF_SURFACE_BSDF_GLSL
#define ISOPHOTE_BSDF_SURFACE_BSDF_GLSL

#include "bsdf/base_bsdf.glsl"
#include "bsdf/clearcoat.glsl"
#include "bsdf/coated_sheen.glsl"
#include "bsdf/layer.glsl"
#include "bsdf/sheen.glsl"

struct SurfaceBsdf {
  MetallicRoughness base;
  Clearcoat coat;
  Sheen sheen;
  bool insideSolid; // wo is in the interior: the layers are on the other side
};

/// Whether facets transmit, so that shadow rays may cross.
bool isGlass(const SurfaceBsdf bsdf) { return kHasTransmission && bsdf.base.glass > 0.0; }

/// Whether light passes to the other side.
bool transmits(const SurfaceBsdf bsdf) {
  return isGlass(bsdf) || (kHasDiffuseTransmission && bsdf.base.behind.share > 0.0);
}

const bool kHasLayers = kHasClearcoat || kHasSheen;

/// A surface that is its base alone.
SurfaceBsdf bareSurface(const MetallicRoughness base) {
  return SurfaceBsdf(base, Clearcoat(0.0, 0.0, vec3(0.0, 0.0, 1.0)), Sheen(vec3(0.0), 0.0), false);
}

/// Shares of the surface that lie bare, under one layer and under both.
struct LayerCover {
  float bare;
  float coat;
  float sheen;
  float both;
};

/// The layers in one direction.
struct LayersAlong {
  LayerCell coatCell;
  LayerCell sheenCell;
  vec3 couplings; // with facets: of the coat, of the sheen and of both
  vec3 broad;     // this direction's factor of the diffuse lobe
};

/// The layers as seen from wo.
struct LayersAtWo {
  Frame coatFrame;
  vec3 woCoat;
  LayerBase base;
  LayerCover cover;
  LayersAlong along;
  vec3 broad;             // the factor of the diffuse lobe that belongs to no direction
  float coatProbability;  // of sampling the coat
  float sheenProbability; // of sampling the sheen where not the coat; the rest is the base's
};

/// What does not depend on wi, and serves all directions from wo.
struct BsdfAtWo {
  BaseShares shares; // of facets and what is below them, where there are facets
  LayersAtWo layers; // where there are layers
};

/// Maps a uniform number beyond `probability` back to [0, 1).
float choiceRemainder(const float u, const float probability) {
  return min((u - probability) / (1.0 - probability), 1.0 - 5.9604644775390625e-8); // 2^-24 below 1
}

// The base keeps a share of the samples however dark it seems: its grazing reflection is white.
const float kMinBaseLuminance = 0.05;

bool isCoated(const SurfaceBsdf bsdf) { return kHasClearcoat && bsdf.coat.amount > 0.0; }

bool hasSheen(const SurfaceBsdf bsdf) { return kHasSheen && sheenAmount(bsdf.sheen) > 0.0; }

bool hasLayers(const SurfaceBsdf bsdf) { return isCoated(bsdf) || hasSheen(bsdf); }

LayerCover layerCover(const SurfaceBsdf bsdf) {
  const float coat = isCoated(bsdf) ? bsdf.coat.amount : 0.0;
  const float sheen = hasSheen(bsdf) ? sheenAmount(bsdf.sheen) : 0.0;
  return LayerCover((1.0 - coat) * (1.0 - sheen), coat * (1.0 - sheen), (1.0 - coat) * sheen, coat * sheen);
}

// The f0 with which f0 A + f90 B is what the coat reflects: its own, where it is Schlick's.
vec3 coatF0(const SurfaceBsdf bsdf, const vec3 reflected, const vec2 albedo, const float f90) {
  if (!hasFilmAlbedo(bsdf.base) && !reflectsExactly(bsdf.base)) return vec3(bsdf.base.dielectricF0);
  return (reflected - f90 * albedo.y) / max(albedo.x, 1e-3);
}

LayerBase layerBase(const SceneRef scene, const SurfaceBsdf bsdf, const BaseShares shares) {
  if (!kHasSpecular) return LayerBase(1.0, 0.0, 0.0, vec2(0.0), vec3(0.0), vec3(1.0));
  const float f90 =
      hasFilmAlbedo(bsdf.base) ? mix(bsdf.base.dielectricF90, 1.0, bsdf.base.film.amount) : bsdf.base.dielectricF90;
  const vec2 mean = facetMeanAlbedo(scene, bsdf.base);
  const vec3 reflected = coatMeanReflected(scene, bsdf.base, mean);
  return LayerBase(sqrt(albedoAlpha(bsdf.base)), f90, kMultipleScattering == 1u ? shares.coatMultiple : 0.0, mean,
                   coatF0(bsdf, reflected, mean, f90), shares.meanCoat);
}

LayerBaseAt layerBaseAt(const SceneRef scene, const SurfaceBsdf bsdf, const LayerBase base, const vec3 w) {
  if (!kHasSpecular) return LayerBaseAt(vec2(0.0), vec3(0.0), vec3(1.0));
  const vec2 albedo = facetAlbedo(scene, bsdf.base, w);
  const vec3 passed = coatTransmissionAt(scene, bsdf.base, abs(w.z), albedo, base.multiple, lostBetweenFacets(albedo));
  const vec3 f0 = coatF0(bsdf, coatReflected(scene, bsdf.base, albedo, abs(w.z)), albedo, base.f90);
  return LayerBaseAt(albedo, f0, max(passed, vec3(1e-4))); // the lobe that it divides has been multiplied by it
}

CoatedSheenCell coatedSheenCell(const SurfaceBsdf bsdf, const LayerBase base, const LayerCell sheenCell) {
  return coatedSheenCell(sheenCell, bsdf.coat.roughness, base.roughness);
}

LayersAlong layersAlong(const SceneRef scene, const SurfaceBsdf bsdf, const LayerBase base, const LayerCover cover,
                        const vec3 w) {
  FloatRef coatTable = FloatRef(scene.view.clearcoatTable);
  FloatRef sheenTable = FloatRef(scene.view.sheenTable);
  const LayerBaseAt at = layerBaseAt(scene, bsdf, base, w);
  LayersAlong along;
  along.couplings = vec3(0.0);
  LayerReturn returned = LayerReturn(0.0, vec2(0.0), 0.0);
  addReturn(returned, cover.bare, 0.0, at.albedo);
  float coat = 0.0;
  if (isCoated(bsdf)) {
    along.coatCell = layerCell(abs(dot(bsdf.coat.normalLocal, w)), bsdf.coat.roughness);
    coat = readLayer(coatTable, kLayerAlbedo, along.coatCell);
    along.couplings.x = readLayerNarrow(coatTable, along.coatCell, base.roughness);
    const vec2 through = readLayerThrough(coatTable, along.coatCell, base.roughness);
    addReturn(returned, cover.coat, coat, at.albedo * through);
  }
  if (hasSheen(bsdf)) {
    along.sheenCell = layerCell(abs(w.z), sheenRow(bsdf.sheen));
    const float sheen = readLayer(sheenTable, kLayerAlbedo, along.sheenCell);
    along.couplings.y = readLayerNarrow(sheenTable, along.sheenCell, base.roughness);
    const vec2 through = readLayerThrough(sheenTable, along.sheenCell, base.roughness);
    addReturn(returned, cover.sheen, sheen, at.albedo * through);
    if (cover.both > 0.0) {
      const CoatedSheenCell cell = coatedSheenCell(bsdf, base, along.sheenCell);
      const CoatedSheen both = readCoatedSheen(Vec4Ref(scene.view.coatedSheenTable), cell, along.sheenCell);
      along.couplings.z = along.couplings.x * both.coupling;
      addReturn(returned, cover.both, coat + sheen - both.taken, at.albedo * both.through);
    }
  }
  along.broad = leftForDiffuse(returned, at.f0, base) / at.transmission;
  return along;
}

// The mean of what layers and facets leave for the diffuse lobe.
vec3 meanLeftForDiffuse(const SceneRef scene, const SurfaceBsdf bsdf, const LayerBase base, const LayerCover cover,
                        const LayersAlong along) {
  FloatRef coatTable = FloatRef(scene.view.clearcoatTable);
  FloatRef sheenTable = FloatRef(scene.view.sheenTable);
  LayerReturn returned = LayerReturn(0.0, vec2(0.0), 0.0);
  addReturn(returned, cover.bare, 0.0, base.meanAlbedo);
  float coat = 0.0;
  if (isCoated(bsdf)) {
    coat = readLayerMean(coatTable, along.coatCell);
    addReturn(returned, cover.coat, coat, readLayerThroughMeans(coatTable, along.coatCell, base.roughness));
  }
  if (hasSheen(bsdf)) {
    const float sheen = readLayerMean(sheenTable, along.sheenCell);
    addReturn(returned, cover.sheen, sheen, readLayerThroughMeans(sheenTable, along.sheenCell, base.roughness));
    if (cover.both > 0.0) {
      const CoatedSheenCell cell = coatedSheenCell(bsdf, base, along.sheenCell);
      const vec3 both = readCoatedSheenMeans(Vec4Ref(scene.view.coatedSheenTable), cell);
      addReturn(returned, cover.both, coat + sheen - both.x, both.yz);
    }
  }
  return leftForDiffuse(returned, base.meanF0, base);
}

LayersAtWo layersAt(const SceneRef scene, const SurfaceBsdf bsdf, const BaseShares shares, const vec3 woLocal) {
  LayersAtWo at;
  at.base = layerBase(scene, bsdf, shares);
  at.cover = layerCover(bsdf);
  at.along = layersAlong(scene, bsdf, at.base, at.cover, woLocal);
  // In place of the coat's own transmissions, by which the base has multiplied its diffuse lobe.
  at.broad = at.along.broad * at.base.meanTransmission /
             max(meanLeftForDiffuse(scene, bsdf, at.base, at.cover, at.along), vec3(kMinCoatTransmission));
  float reachable = 1.0; // share of the light that comes down to the layer at hand
  float coatShare = 0.0;
  if (isCoated(bsdf)) {
    at.coatFrame = coatFrame(bsdf.coat);
    at.woCoat = toLocal(at.coatFrame, woLocal);
    coatShare = bsdf.coat.amount * readLayer(FloatRef(scene.view.clearcoatTable), kLayerAlbedo, at.along.coatCell);
    reachable -= coatShare;
    if (at.woCoat.z < kMinCosine || bsdf.insideSolid) coatShare = 0.0;
  }
  float sheenShare = 0.0;
  if (hasSheen(bsdf)) {
    const float albedo = readLayer(FloatRef(scene.view.sheenTable), kLayerAlbedo, at.along.sheenCell);
    if (!bsdf.insideSolid) sheenShare = reachable * luminance(bsdf.sheen.color) * albedo;
    reachable *= 1.0 - sheenAmount(bsdf.sheen) * albedo;
  }
  const float base = reachable * max(luminance(max(bsdf.base.baseColor, bsdf.base.f0)), kMinBaseLuminance);
  const float below = sheenShare + base;
  at.coatProbability = coatShare > 0.0 ? coatShare / (coatShare + below) : 0.0;
  at.sheenProbability = sheenShare > 0.0 ? sheenShare / below : 0.0;
  return at;
}

// Refraction crosses the layers once, on the outside; what they would throw back into the interior is lost.
float passageOutside(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const vec3 wiLocal) {
  float passed = 1.0;
  if (isCoated(bsdf)) {
    LayerCell cell = at.along.coatCell;
    if (bsdf.insideSolid) cell = layerCell(abs(dot(bsdf.coat.normalLocal, wiLocal)), bsdf.coat.roughness);
    passed = 1.0 - bsdf.coat.amount * readLayer(FloatRef(scene.view.clearcoatTable), kLayerAlbedo, cell);
  }
  if (hasSheen(bsdf)) {
    LayerCell cell = at.along.sheenCell;
    if (bsdf.insideSolid) cell = layerCell(abs(wiLocal.z), sheenRow(bsdf.sheen));
    passed *= 1.0 - sheenAmount(bsdf.sheen) * readLayer(FloatRef(scene.view.sheenTable), kLayerAlbedo, cell);
  }
  return passed;
}

// What the layers leave of what the base scatters from wo to wi. Thin walls carry them on both sides, so that
// transmission passes them as reflection does.
LayerPassage passageThrough(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const vec3 wiLocal,
                            out LayersAlong along) {
  if (kHasFarSide && wiLocal.z < 0.0 && !bsdf.base.thinWalled) {
    const float passed = passageOutside(scene, bsdf, at, wiLocal);
    return LayerPassage(passed, vec3(passed));
  }
  if (bsdf.insideSolid) return LayerPassage(1.0, vec3(1.0));
  along = layersAlong(scene, bsdf, at.base, at.cover, wiLocal);
  const vec3 couplings = at.along.couplings * along.couplings;
  return LayerPassage(at.cover.bare + at.cover.coat * couplings.x + at.cover.sheen * couplings.y +
                          at.cover.both * couplings.z,
                      at.broad * along.broad);
}

// The lobes of the layers themselves, added to what comes from below.
void addLayerLobes(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const LayersAlong along,
                   const vec3 woLocal, const vec3 wiLocal, inout BsdfValue value) {
  if (bsdf.insideSolid || wiLocal.z < kMinCosine) return;
  float underCoat = 1.0;
  vec2 coat = vec2(0.0);
  if (isCoated(bsdf)) {
    const vec3 wiCoat = toLocal(at.coatFrame, wiLocal);
    coat = evaluateCoat(bsdf.coat, at.woCoat, wiCoat);
    underCoat =
        passageOfEither(FloatRef(scene.view.clearcoatTable), at.along.coatCell, along.coatCell, bsdf.coat.amount);
  }
  if (hasSheen(bsdf)) {
    const float sheen =
        evalSheen(FloatRef(scene.view.sheenTable), bsdf.sheen, at.along.sheenCell, along.sheenCell, woLocal, wiLocal);
    value.fCos += bsdf.sheen.color * (underCoat * sheen);
    value.pdfSolidAngle += (1.0 - at.coatProbability) * at.sheenProbability * kInvTwoPi;
  }
  if (kHasClearcoat) {
    value.fCos += vec3(bsdf.coat.amount * coat.x);
    value.pdfSolidAngle += at.coatProbability * coat.y;
  }
}

// The base's lobes through the layers, and the layers' own.
BsdfValue underLayers(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const BaseValue base,
                      const vec3 woLocal, const vec3 wiLocal) {
  LayersAlong along;
  const LayerPassage passage = passageThrough(scene, bsdf, at, wiLocal, along);
  BsdfValue value;
  value.fCos = base.diffuse * passage.broad + base.facets * passage.narrow;
  value.pdfSolidAngle = (1.0 - at.coatProbability) * (1.0 - at.sheenProbability) * base.pdfSolidAngle;
  addLayerLobes(scene, bsdf, at, along, woLocal, wiLocal, value);
  return value;
}

BsdfAtWo bsdfAtWo(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal) {
  BsdfAtWo at;
  if (kHasSpecular) at.shares = baseShares(scene, bsdf.base, woLocal);
  if (kHasLayers && hasLayers(bsdf)) at.layers = layersAt(scene, bsdf, at.shares, woLocal);
  return at;
}

/// Returns f |cos wi| and the sampling density of the continuous lobes.
/// @param at bsdfAtWo of wo
BsdfValue evaluateBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const BsdfAtWo at, const vec3 woLocal,
                       const vec3 wiLocal) {
  const bool layered = kHasLayers && hasLayers(bsdf);
  if (layered && min(woLocal.z, abs(wiLocal.z)) < kMinCosine) return BsdfValue(vec3(0.0), 0.0);
  const BaseValue base = evaluateBase(scene, bsdf.base, at.shares, woLocal, wiLocal);
  if (layered) return underLayers(scene, bsdf, at.layers, base, woLocal, wiLocal);
  return BsdfValue(base.facets + base.diffuse, base.pdfSolidAngle);
}

BsdfSample drawFromCoat(const SurfaceBsdf bsdf, const LayersAtWo at, const float uLobe, const vec2 u) {
  const vec3 wi = toWorld(at.coatFrame, sampleCoat(bsdf.coat, at.woCoat, u, uLobe / at.coatProbability));
  if (wi.z < kMinCosine) return absorbed();
  if (!coatIsMirror(bsdf.coat)) return drawnDirection(wi, 1.0);
  const vec3 weight = vec3(bsdf.coat.amount * coatReflectance(at.woCoat.z) / at.coatProbability);
  return BsdfSample(wi, weight, 0.0, true, true, 1.0);
}

/// Draws a direction of scattering: one of three lobes, coat, sheen or base, by the probabilities in `at`.
///
/// @param at    bsdfAtWo of wo
/// @param uLobe in [0, 1), chooses the lobe
/// @param u     in [0, 1)^2
BsdfSample drawBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const BsdfAtWo at, const vec3 woLocal, float uLobe,
                    const vec2 u) {
  if (woLocal.z < kMinCosine) return absorbed();
  const bool layered = kHasLayers && hasLayers(bsdf);
  const LayersAtWo layers = at.layers;
  if (layered) {
    if (uLobe < layers.coatProbability) return drawFromCoat(bsdf, layers, uLobe, u);
    uLobe = choiceRemainder(uLobe, layers.coatProbability);
    if (uLobe < layers.sheenProbability) return drawnDirection(sampleSheen(u), 1.0);
    uLobe = choiceRemainder(uLobe, layers.sheenProbability);
  }
  BsdfSample drawn = drawBase(bsdf.base, at.shares, woLocal, uLobe, u);
  if (layered && drawn.delta) {
    LayersAlong along;
    drawn.weight *= passageThrough(scene, bsdf, layers, drawn.wiLocal, along).narrow /
                    ((1.0 - layers.coatProbability) * (1.0 - layers.sheenProbability));
  }
  return drawn;
}

#endif
