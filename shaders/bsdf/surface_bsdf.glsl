// The scattering of a surface: a clearcoat over a sheen over the base. Formulas: docs/bsdf-layers.md, "Layers".
//
// Directions are unit and in the local shading frame, z the shading normal on wo's side.
#ifndef ISOPHOTE_BSDF_SURFACE_BSDF_GLSL
#define ISOPHOTE_BSDF_SURFACE_BSDF_GLSL

#include "bsdf/clearcoat.glsl"
#include "bsdf/layer.glsl"
#include "bsdf/base_bsdf.glsl"
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

/// What does not depend on wi: the layers as seen from wo.
struct LayersAtWo {
  Frame coatFrame;
  vec3 woCoat;
  LayerCell coatCell;
  LayerCell sheenCell;
  LayerBase base;
  LayerBaseAt baseAtWo;
  float coatProbability;  // of sampling the coat
  float sheenProbability; // of sampling the sheen where not the coat; the rest is the base's
};

bool hasLayers(const SurfaceBsdf bsdf) {
  return (kHasClearcoat && bsdf.coat.amount > 0.0) || (kHasSheen && sheenAmount(bsdf.sheen) > 0.0);
}

/// Maps a uniform number beyond `probability` back to [0, 1).
float choiceRemainder(const float u, const float probability) {
  return min((u - probability) / (1.0 - probability), 1.0 - 5.9604644775390625e-8); // 2^-24 below 1
}

// The base keeps a share of the samples however dark it seems: its grazing reflection is white.
const float kMinBaseLuminance = 0.05;

LayerBaseAt layerBaseAt(const SceneRef scene, const SurfaceBsdf bsdf, const LayerBase base, const vec3 w) {
  if (!kHasSpecular) return LayerBaseAt(vec2(0.0), 1.0);
  const vec2 albedo = facetAlbedo(scene, bsdf.base, w);
  const float passed = coatTransmissionAt(scene, bsdf.base, abs(w.z), albedo, base.multiple, lostBetweenFacets(albedo));
  return LayerBaseAt(albedo, max(passed, 1e-4)); // the lobe that it divides has been multiplied by it
}

LayersAtWo layersAt(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal) {
  LayersAtWo at;
  at.base = LayerBase(1.0, 0.0, 0.0, 0.0, vec2(0.0), 1.0);
  if (kHasSpecular) {
    const BaseShares shares = baseShares(scene, bsdf.base, woLocal);
    at.base = LayerBase(sqrt(albedoAlpha(bsdf.base)), bsdf.base.dielectricF0, bsdf.base.dielectricF90,
                        kMultipleScattering == 1u ? shares.coatMultiple : 0.0, facetMeanAlbedo(scene, bsdf.base),
                        shares.meanCoat);
  }
  at.baseAtWo = layerBaseAt(scene, bsdf, at.base, woLocal);
  float reachable = 1.0; // share of the light that comes down to the layer at hand
  float coatShare = 0.0;
  if (kHasClearcoat && bsdf.coat.amount > 0.0) {
    at.coatFrame = coatFrame(bsdf.coat);
    at.woCoat = toLocal(at.coatFrame, woLocal);
    at.coatCell = layerCell(abs(at.woCoat.z), bsdf.coat.roughness);
    coatShare = bsdf.coat.amount * readLayer(FloatRef(scene.view.clearcoatTable), kLayerAlbedo, at.coatCell);
    reachable -= coatShare;
    if (at.woCoat.z < kMinCosine || bsdf.insideSolid) coatShare = 0.0;
  }
  float sheenShare = 0.0;
  if (kHasSheen && sheenAmount(bsdf.sheen) > 0.0) {
    at.sheenCell = layerCell(woLocal.z, sheenRow(bsdf.sheen));
    const float albedo = readLayer(FloatRef(scene.view.sheenTable), kLayerAlbedo, at.sheenCell);
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
  if (kHasClearcoat && bsdf.coat.amount > 0.0) {
    LayerCell cell = at.coatCell;
    if (bsdf.insideSolid) cell = layerCell(abs(dot(bsdf.coat.normalLocal, wiLocal)), bsdf.coat.roughness);
    passed = 1.0 - bsdf.coat.amount * readLayer(FloatRef(scene.view.clearcoatTable), kLayerAlbedo, cell);
  }
  if (kHasSheen && sheenAmount(bsdf.sheen) > 0.0) {
    LayerCell cell = at.sheenCell;
    if (bsdf.insideSolid) cell = layerCell(abs(wiLocal.z), sheenRow(bsdf.sheen));
    passed *= 1.0 - sheenAmount(bsdf.sheen) * readLayer(FloatRef(scene.view.sheenTable), kLayerAlbedo, cell);
  }
  return passed;
}

// What a clearcoat and a sheen below it leave for the diffuse lobe to give back.
float leftByBoth(const SceneRef scene, const SurfaceBsdf bsdf, const LayerCell coatCell, const LayerCell sheenCell) {
  FloatRef sheenTable = FloatRef(scene.view.sheenTable);
  const float coat = bsdf.coat.amount * readLayer(FloatRef(scene.view.clearcoatTable), kLayerAlbedo, coatCell);
  const float sheen = readLayer(sheenTable, kLayerAlbedo, sheenCell) -
                      bsdf.coat.amount * readLayerWith(sheenTable, kCoatedSheen, sheenCell, bsdf.coat.roughness);
  return max(1.0 - coat - sheenAmount(bsdf.sheen) * sheen, 0.0);
}

// The diffuse lobe's passage through both, lossless as through one.
float broadThroughBoth(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const LayerCell coatCellI,
                       const LayerCell sheenCellI) {
  FloatRef sheenTable = FloatRef(scene.view.sheenTable);
  const float roughness = at.base.roughness;
  const vec3 coat = readLayerMeans(FloatRef(scene.view.clearcoatTable), at.coatCell, roughness);
  const vec3 sheen = readLayerMeans(sheenTable, at.sheenCell, roughness);
  const vec3 coatedSheen = readCoatedSheenMeans(sheenTable, at.sheenCell, bsdf.coat.roughness, roughness);
  const float amount = sheenAmount(bsdf.sheen);
  const vec3 lost = bsdf.coat.amount * coat + amount * (sheen - bsdf.coat.amount * coatedSheen);
  return leftByBoth(scene, bsdf, at.coatCell, at.sheenCell) * leftByBoth(scene, bsdf, coatCellI, sheenCellI) /
         meanPassed(lost, at.base);
}

// A coat's and a sheen's couplings with facets both favor steep directions, so that their product would send back more
// than arrives, by up to 0.93% (docs/bsdf-layers.md).
const float kBothLayersLoss = 0.01;

// What the layers leave of what the base scatters from wo to wi. Thin walls carry them on both sides, so that
// transmission passes them as reflection does.
LayerPassage passageThrough(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const vec3 wiLocal) {
  LayerPassage passage = LayerPassage(1.0, 1.0);
  if (kHasFarSide && wiLocal.z < 0.0 && !bsdf.base.thinWalled) {
    const float passed = passageOutside(scene, bsdf, at, wiLocal);
    return LayerPassage(passed, passed);
  }
  if (bsdf.insideSolid) return passage;
  const bool coated = kHasClearcoat && bsdf.coat.amount > 0.0;
  const LayerBaseAt baseAtWi = layerBaseAt(scene, bsdf, at.base, wiLocal);
  LayerCell coatCell;
  if (coated) {
    coatCell = layerCell(abs(dot(bsdf.coat.normalLocal, wiLocal)), bsdf.coat.roughness);
    passage = layerPassage(FloatRef(scene.view.clearcoatTable), at.coatCell, coatCell, bsdf.coat.amount, at.base,
                           at.baseAtWo, baseAtWi);
  }
  if (kHasSheen && sheenAmount(bsdf.sheen) > 0.0) {
    const LayerCell cell = layerCell(abs(wiLocal.z), sheenRow(bsdf.sheen));
    const LayerPassage sheen = layerPassage(FloatRef(scene.view.sheenTable), at.sheenCell, cell,
                                            sheenAmount(bsdf.sheen), at.base, at.baseAtWo, baseAtWi);
    passage.narrow *=
        sheen.narrow * (coated ? 1.0 - kBothLayersLoss * bsdf.coat.amount * sheenAmount(bsdf.sheen) : 1.0);
    passage.broad = coated ? broadThroughBoth(scene, bsdf, at, coatCell, cell) : sheen.broad;
  }
  return passage;
}

// The lobes of the layers themselves, added to what comes from below.
void addLayerLobes(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const vec3 woLocal,
                   const vec3 wiLocal, inout BsdfValue value) {
  if (bsdf.insideSolid || wiLocal.z < kMinCosine) return;
  float underCoat = 1.0;
  vec2 coat = vec2(0.0);
  if (kHasClearcoat && bsdf.coat.amount > 0.0) {
    const vec3 wiCoat = toLocal(at.coatFrame, wiLocal);
    coat = evaluateCoat(bsdf.coat, at.woCoat, wiCoat);
    underCoat = passageOfEither(FloatRef(scene.view.clearcoatTable), at.coatCell,
                                layerCell(abs(wiCoat.z), bsdf.coat.roughness), bsdf.coat.amount);
  }
  if (kHasSheen && sheenAmount(bsdf.sheen) > 0.0) {
    const LayerCell cell = layerCell(wiLocal.z, sheenRow(bsdf.sheen));
    value.fCos += bsdf.sheen.color * (underCoat * evalSheen(FloatRef(scene.view.sheenTable), bsdf.sheen, at.sheenCell,
                                                            cell, woLocal, wiLocal));
    value.pdfSolidAngle += (1.0 - at.coatProbability) * at.sheenProbability * kInvTwoPi;
  }
  if (kHasClearcoat) {
    value.fCos += vec3(bsdf.coat.amount * coat.x);
    value.pdfSolidAngle += at.coatProbability * coat.y;
  }
}

BsdfValue evaluateLayered(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const vec3 woLocal,
                          const vec3 wiLocal) {
  const BaseValue base = evaluateBase(scene, bsdf.base, woLocal, wiLocal);
  const LayerPassage passage = passageThrough(scene, bsdf, at, wiLocal);
  BsdfValue value;
  value.fCos = base.diffuse * passage.broad + base.facets * passage.narrow;
  value.pdfSolidAngle = (1.0 - at.coatProbability) * (1.0 - at.sheenProbability) * base.pdfSolidAngle;
  addLayerLobes(scene, bsdf, at, woLocal, wiLocal, value);
  return value;
}

/// Returns f |cos wi| and the sampling density of the continuous lobes.
BsdfValue evaluateBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal, const vec3 wiLocal) {
  if (kHasLayers && hasLayers(bsdf)) {
    if (min(woLocal.z, abs(wiLocal.z)) < kMinCosine) return BsdfValue(vec3(0.0), 0.0);
    return evaluateLayered(scene, bsdf, layersAt(scene, bsdf, woLocal), woLocal, wiLocal);
  }
  const BaseValue base = evaluateBase(scene, bsdf.base, woLocal, wiLocal);
  return BsdfValue(base.facets + base.diffuse, base.pdfSolidAngle);
}

/// Returns f |cos wi| of the continuous lobes.
vec3 evalBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal, const vec3 wiLocal) {
  return evaluateBsdf(scene, bsdf, woLocal, wiLocal).fCos;
}

/// Returns the density of sampleBsdf's continuous lobes, per steradian of wi, lobe probabilities included.
float pdfBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal, const vec3 wiLocal) {
  return evaluateBsdf(scene, bsdf, woLocal, wiLocal).pdfSolidAngle;
}

/// A continuous sample weighed by all that may have drawn its direction.
BsdfSample weighed(BsdfSample drawn, const BsdfValue value) {
  drawn.pdfSolidAngle = value.pdfSolidAngle;
  drawn.weight = value.pdfSolidAngle > 0.0 ? value.fCos / value.pdfSolidAngle : vec3(0.0);
  drawn.valid = max(drawn.weight.x, max(drawn.weight.y, drawn.weight.z)) > 0.0;
  return drawn;
}

// The base's choice weighed anew: the layers dim it, and their lobes may have sampled it too.
BsdfSample weighLayered(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const vec3 woLocal,
                        const BsdfSample drawn) {
  return weighed(drawn, evaluateLayered(scene, bsdf, at, woLocal, drawn.wiLocal));
}

// One of three lobes, coat, sheen or base, by the probabilities in `at`.
BsdfSample sampleLayered(const SceneRef scene, const SurfaceBsdf bsdf, const LayersAtWo at, const vec3 woLocal,
                         float uLobe, const vec2 u) {
  BsdfSample drawn = absorbed();
  if (uLobe < at.coatProbability) {
    drawn.wiLocal = toWorld(at.coatFrame, sampleCoat(bsdf.coat, at.woCoat, u, uLobe / at.coatProbability));
    if (drawn.wiLocal.z < kMinCosine) return drawn;
    if (!coatIsMirror(bsdf.coat)) return weighLayered(scene, bsdf, at, woLocal, drawn);
    drawn.weight = vec3(bsdf.coat.amount * coatReflectance(at.woCoat.z) / at.coatProbability);
    drawn.delta = true;
    drawn.valid = true;
    return drawn;
  }
  uLobe = choiceRemainder(uLobe, at.coatProbability);
  if (uLobe < at.sheenProbability) {
    drawn.wiLocal = sampleSheen(u);
    if (drawn.wiLocal.z < kMinCosine) return drawn;
    return weighLayered(scene, bsdf, at, woLocal, drawn);
  }
  drawn = sampleBase(scene, bsdf.base, woLocal, choiceRemainder(uLobe, at.sheenProbability), u);
  if (drawn.delta) {
    drawn.weight *= passageThrough(scene, bsdf, at, drawn.wiLocal).narrow /
                    ((1.0 - at.coatProbability) * (1.0 - at.sheenProbability));
    return drawn;
  }
  // A direction that the base cannot scatter to is no loss where a layer can.
  return drawn.pdfSolidAngle > 0.0 ? weighLayered(scene, bsdf, at, woLocal, drawn) : drawn;
}

/// Samples a direction of scattering, weighed over all lobes.
///
/// @param uLobe in [0, 1), chooses the lobe
/// @param u     in [0, 1)^2
BsdfSample sampleBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal, const float uLobe,
                      const vec2 u) {
  if (kHasLayers && hasLayers(bsdf) && woLocal.z >= kMinCosine) {
    return sampleLayered(scene, bsdf, layersAt(scene, bsdf, woLocal), woLocal, uLobe, u);
  }
  return sampleBase(scene, bsdf.base, woLocal, uLobe, u);
}

#endif
