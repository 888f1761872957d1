// The material of a surface point: factors times textures times vertex color, and the normal it is shaded with.
#ifndef ISOPHOTE_BSDF_MATERIAL_GLSL
#define ISOPHOTE_BSDF_MATERIAL_GLSL

#include "bsdf/dispersion.glsl"
#include "bsdf/surface_bsdf.glsl"
#include "geometry/attributes.glsl"
#include "geometry/surface.glsl"
#include "geometry/texture_slot.glsl"
#include "math/frame.glsl"
#include "math/normalize.glsl"
#include "shared/buffers.glsl"
#include "shared/constants.glsl"

struct SurfaceMaterial {
  SurfaceBsdf bsdf;
  vec3 baseColor; // linear, as authored: an unlit surface's radiance
  bool unlit;
};

// A normal that leans away from the viewer is turned back until its cosine to wo is this (or that of ng, if smaller).
const float kMinShadingCosine = 0.01;

vec4 materialTexel(const SceneRef scene, const SurfaceHit surface, const Geometry geometry, const uint slot) {
  return readSlot(scene, geometry, surface.primitiveIndex, surface.barycentrics, slot, vec4(1.0));
}

/// Index behind a surface over the index in front of it, where the place outside is filled with air.
/// @return 0 stands for infinity as in KHR_materials_ior
float etaInAir(const SceneRef scene, const SurfaceHit surface, const uint channel) {
  const float ior = materialIor(MaterialRef(scene.view.materials).items[surface.material], channel);
  const bool boundary = (MaterialRef(scene.view.materials).items[surface.material].flags & kMaterialVolume) != 0u;
  return relativeIor(ior, surface.frontFace || !boundary || ior < 1.0);
}

// What lies over the base: of the clearcoat factor R, roughness G; of the sheen color RGB, roughness A.
void addLayers(const SceneRef scene, const SurfaceHit surface, const MaterialRecord record, const Geometry geometry,
               inout SurfaceBsdf bsdf) {
  bsdf.insideSolid = transmits(bsdf) && !bsdf.base.thinWalled && !surface.frontFace;
  bsdf.coat = Clearcoat(0.0, 0.0, vec3(0.0, 0.0, 1.0));
  if (kHasClearcoat && record.clearcoat > 0.0) {
    bsdf.coat.amount = record.clearcoat * materialTexel(scene, surface, geometry, record.clearcoatSlot).r;
    bsdf.coat.roughness =
        record.clearcoatRoughness * materialTexel(scene, surface, geometry, record.clearcoatRoughnessSlot).g;
  }
  bsdf.sheen = Sheen(vec3(0.0), 0.0);
  if (kHasSheen && record.sheenColor != vec3(0.0)) {
    bsdf.sheen.color = record.sheenColor * materialTexel(scene, surface, geometry, record.sheenColorSlot).rgb;
    bsdf.sheen.roughness = record.sheenRoughness * materialTexel(scene, surface, geometry, record.sheenRoughnessSlot).a;
  }
}

// KHR_materials_anisotropy: RG the direction, 2t - 1, in the tangent plane, B the strength.
vec3 anisotropyTexel(const SceneRef scene, const SurfaceHit surface, const Geometry geometry, const uint slot) {
  return readSlot(scene, geometry, surface.primitiveIndex, surface.barycentrics, slot, vec4(1.0, 0.5, 1.0, 1.0)).rgb;
}

// KHR_materials_iridescence: factor R, thickness G.
Iridescence iridescenceAt(const SceneRef scene, const SurfaceHit surface, const MaterialRecord record,
                          const Geometry geometry) {
  const float thickness = materialTexel(scene, surface, geometry, record.iridescenceThicknessSlot).g;
  return Iridescence(record.iridescence * materialTexel(scene, surface, geometry, record.iridescenceSlot).r,
                     record.iridescenceIor,
                     mix(record.iridescenceThicknessMinimum, record.iridescenceThicknessMaximum, thickness));
}

// KHR_materials_diffuse_transmission: factor A, color RGB. Light meets another index behind the surface only where the
// material can refract.
DiffuseTransmission diffuseTransmissionAt(const SceneRef scene, const SurfaceHit surface, const MaterialRecord record,
                                          const Geometry geometry, const float eta) {
  const vec3 color = materialTexel(scene, surface, geometry, record.diffuseTransmissionColorSlot).rgb;
  const bool refracts = kHasTransmission && record.transmission > 0.0 && record.thickness > 0.0 && eta > 0.0;
  return DiffuseTransmission(record.diffuseTransmission *
                                 materialTexel(scene, surface, geometry, record.diffuseTransmissionSlot).a,
                             clamp(record.diffuseTransmissionColor * color, 0.0, 1.0), refracts ? eta : 1.0);
}

/// Reads the material at a hit. Channels as in glTF 2.0 section 3.9 and KHR_materials_specular: roughness G, metallic
/// B, specular A, transmission R, diffuse transmission A. Base color above 1, which float vertex colors can give, is
/// cut to 1 where it is a reflectance.
///
/// @param eta      index behind the surface over the index in front of it, as etaInAir has it in air
/// @param channel  of the index of dispersive glass, 1 for its nominal one
SurfaceMaterial materialAt(const SceneRef scene, const SurfaceHit surface, const float eta, const uint channel) {
  const MaterialRecord record = MaterialRef(scene.view.materials).items[surface.material];
  const Geometry geometry = GeometryRef(scene.view.geometries).items[surface.geometry];
  SurfaceMaterial material;
  material.baseColor = record.baseColor.rgb * materialTexel(scene, surface, geometry, record.baseColorSlot).rgb *
                       interpolateColor(scene, geometry, surface.primitiveIndex, surface.barycentrics).rgb;
  material.unlit = kHasUnlit && (record.flags & kMaterialUnlit) != 0u;
  const vec3 reflectance = clamp(material.baseColor, 0.0, 1.0);
  if (kHasSpecular) {
    const bool dispersive = kHasDispersion && isDispersive(record);
    const float ior = dispersive ? channelIor(record, channel) : record.ior;
    const vec4 packed = materialTexel(scene, surface, geometry, record.metallicRoughnessSlot);
    const float specular = record.specular * materialTexel(scene, surface, geometry, record.specularSlot).a;
    const vec3 specularColor =
        record.specularColor * materialTexel(scene, surface, geometry, record.specularColorSlot).rgb;
    material.bsdf.base = metallicRoughness(reflectance, record.metallic * packed.b, record.roughness * packed.g, eta,
                                           specular, specularColor);
    setExactAlbedo(material.bsdf.base, record.ior, record.exactAlbedo);
    if (kHasAnisotropy && record.anisotropyStrength > 0.0) {
      setAnisotropy(material.bsdf.base,
                    record.anisotropyStrength * anisotropyTexel(scene, surface, geometry, record.anisotropySlot).b,
                    record.anisotropicAlbedo);
    }
    if (kHasTransmission && ior >= 1.0) {
      const float transmission =
          record.transmission * materialTexel(scene, surface, geometry, record.transmissionSlot).r;
      const bool thinWalled = record.thickness == 0.0;
      setTransmission(material.bsdf.base, transmission, eta, thinWalled);
      // The tables are those of the material in air: between other media nothing is restored.
      if (eta == relativeIor(ior, surface.frontFace)) {
        setGlassLoss(material.bsdf.base,
                     dispersive ? record.glassLoss + channel * 2u * kGlassLossHalf : record.glassLoss,
                     surface.frontFace);
      }
    }
    if (kHasConductor && (record.flags & kMaterialConductor) != 0u) {
      setConductor(material.bsdf.base, record.conductorN, record.conductorK);
    }
    if (kHasIridescence && record.iridescence > 0.0) {
      // Its table is of the material in air, too.
      const bool inAir = eta == relativeIor(record.ior, true) || eta == relativeIor(record.ior, false);
      setIridescence(material.bsdf.base, iridescenceAt(scene, surface, record, geometry),
                     inAir ? record.filmAlbedo : kInvalidIndex);
    }
  } else {
    material.bsdf.base = metallicRoughness(reflectance, 0.0, 1.0, 1.0, 0.0, vec3(0.0));
  }
  if (kHasDiffuseTransmission && record.diffuseTransmission > 0.0) {
    setDiffuseTransmission(material.bsdf.base, diffuseTransmissionAt(scene, surface, record, geometry, eta),
                           record.thickness == 0.0);
  }
  addLayers(scene, surface, record, geometry, material.bsdf);
  return material;
}

/// The same in air, of the nominal index.
SurfaceMaterial materialAt(const SceneRef scene, const SurfaceHit surface) {
  return materialAt(scene, surface, etaInAir(scene, surface, 1u), 1u);
}

/// Turns ns towards wo, in their plane, just so far that dot(wo, ns) = c = min(kMinShadingCosine, dot(wo, ng)):
/// ns' = c wo + sqrt(1 - c^2) t, t the unit part of ns orthogonal to wo. Continuous in ns; a flat surface stays as it
/// is.
/// @param ns, ng, wo unit, dot(wo, ng) >= 0
vec3 bendTowards(const vec3 ns, const vec3 ng, const vec3 wo) {
  const float cosine = dot(wo, ns);
  const float least = min(kMinShadingCosine, dot(wo, ng));
  if (cosine >= least) return ns;
  const vec3 across = ns - cosine * wo;
  const float length2 = dot(across, across);
  if (length2 < 1e-8) return ng; // ns points away from wo: no plane to turn in
  return least * wo + sqrt(1.0 - least * least) * inversesqrt(length2) * across;
}

/// Returns the unit normal to shade with, on wo's side: interpolated, bumped by a normal map, bent towards wo.
///
/// The map's texel t gives normalize((2 t - 1) * (scale, scale, 1)) in the frame (tangent, w cross(ns, tangent), ns) of
/// the front side (glTF 2.0, section 3.9.3); a back side has the negative of it.
/// @param surface as seen from wo
/// @param slot    of the map, or kInvalidIndex
vec3 bumpedNormal(const SceneRef scene, const SurfaceHit surface, const uint slot, const vec3 wo) {
  vec3 ns = surface.ns;
  if (kHasNormalMaps) {
    if (slot != kInvalidIndex) {
      const Geometry geometry = GeometryRef(scene.view.geometries).items[surface.geometry];
      const float scale = TextureSlotRef(scene.view.textureSlots).items[slot].scale;
      const vec3 texel = materialTexel(scene, surface, geometry, slot).xyz;
      const vec3 bump = (2.0 * texel - 1.0) * vec3(scale, scale, 1.0);
      const float side = surface.frontFace ? 1.0 : -1.0;
      const Frame frame = frameFromNormalTangent(side * surface.ns, surface.tangent.xyz, surface.tangent.w);
      ns = side * safeNormalize(toWorld(frame, bump), side * surface.ns);
    }
  }
  if (kHasShadingNormals || kHasNormalMaps) ns = bendTowards(ns, surface.ng, wo);
  return ns;
}

/// The local frame of scattering: z the shading normal, x the direction of anisotropy where the surface has one.
Frame shadingFrame(const SceneRef scene, const SurfaceHit surface, const vec3 ns) {
  if (kHasAnisotropy) {
    const MaterialRecord record = MaterialRef(scene.view.materials).items[surface.material];
    if (record.anisotropyStrength > 0.0) {
      const Geometry geometry = GeometryRef(scene.view.geometries).items[surface.geometry];
      const vec2 direction = 2.0 * anisotropyTexel(scene, surface, geometry, record.anisotropySlot).rg - 1.0;
      const vec2 turn = sinCosPi(2.0 * fract(record.anisotropyRotation * kInvTwoPi));
      const vec2 turned =
          vec2(turn.y * direction.x - turn.x * direction.y, turn.x * direction.x + turn.y * direction.y);
      const float side = surface.frontFace ? 1.0 : -1.0;
      const Frame front = frameFromNormalTangent(side * ns, surface.tangent.xyz, surface.tangent.w);
      return frameFromNormalTangent(ns, turned.x * front.tangent + turned.y * front.bitangent, 1.0);
    }
  }
  return frameFromNormal(ns);
}

/// The base's shading normal.
vec3 shadingNormal(const SceneRef scene, const SurfaceHit surface, const vec3 wo) {
  const uint slot =
      kHasNormalMaps ? MaterialRef(scene.view.materials).items[surface.material].normalSlot : kInvalidIndex;
  return bumpedNormal(scene, surface, slot, wo);
}

/// The clearcoat's: it has a normal map of its own, or none.
vec3 clearcoatNormal(const SceneRef scene, const SurfaceHit surface, const vec3 wo) {
  const uint slot =
      kHasNormalMaps ? MaterialRef(scene.view.materials).items[surface.material].clearcoatNormalSlot : kInvalidIndex;
  return bumpedNormal(scene, surface, slot, wo);
}

/// Gives the clearcoat its normal in the frame of the base.
void setClearcoatNormal(inout SurfaceMaterial material, const SceneRef scene, const SurfaceHit surface, const vec3 wo,
                        const Frame frame) {
  if (material.bsdf.coat.amount <= 0.0) return;
  material.bsdf.coat.normalLocal = toLocal(frame, clearcoatNormal(scene, surface, wo));
}

#endif
