// The material of a surface point: factors times textures times vertex color, and the normal it is shaded with.
#ifndef ISOPHOTE_BSDF_MATERIAL_GLSL
#define ISOPHOTE_BSDF_MATERIAL_GLSL

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

/// Reads the material at a hit. Channels as in glTF 2.0 section 3.9 and KHR_materials_specular: roughness G, metallic
/// B, specular A, transmission R. Base color above 1, which float vertex colors can give, is cut to 1 where it is a
/// reflectance.
SurfaceMaterial materialAt(const SceneRef scene, const SurfaceHit surface) {
  const MaterialRecord record = MaterialRef(scene.view.materials).items[surface.material];
  const Geometry geometry = GeometryRef(scene.view.geometries).items[surface.geometry];
  SurfaceMaterial material;
  material.baseColor = record.baseColor.rgb * materialTexel(scene, surface, geometry, record.baseColorSlot).rgb *
                       interpolateColor(scene, geometry, surface.primitiveIndex, surface.barycentrics).rgb;
  material.unlit = kHasUnlit && (record.flags & kMaterialUnlit) != 0u;
  const vec3 reflectance = clamp(material.baseColor, 0.0, 1.0);
  if (kHasSpecular) {
    const vec4 packed = materialTexel(scene, surface, geometry, record.metallicRoughnessSlot);
    const float specular = record.specular * materialTexel(scene, surface, geometry, record.specularSlot).a;
    const vec3 specularColor =
        record.specularColor * materialTexel(scene, surface, geometry, record.specularColorSlot).rgb;
    material.bsdf.base = metallicRoughness(reflectance, record.metallic * packed.b, record.roughness * packed.g,
                                           record.ior, specular, specularColor);
    if (kHasTransmission && record.ior >= 1.0) {
      const float transmission =
          record.transmission * materialTexel(scene, surface, geometry, record.transmissionSlot).r;
      const bool thinWalled = record.thickness == 0.0;
      setTransmission(material.bsdf.base, transmission, relativeIor(record.ior, surface.frontFace || thinWalled),
                      thinWalled);
    }
  } else {
    material.bsdf.base = metallicRoughness(reflectance, 0.0, 1.0, 1.0, 0.0, vec3(0.0));
  }
  return material;
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

/// Returns the unit normal to shade with, on wo's side: interpolated, bumped by the normal map, bent towards wo.
///
/// The map's texel t gives normalize((2 t - 1) * (scale, scale, 1)) in the frame (tangent, w cross(ns, tangent), ns) of
/// the front side (glTF 2.0, section 3.9.3); a back side has the negative of it.
/// @param surface as seen from wo
vec3 shadingNormal(const SceneRef scene, const SurfaceHit surface, const vec3 wo) {
  vec3 ns = surface.ns;
  if (kHasNormalMaps) {
    const uint slot = MaterialRef(scene.view.materials).items[surface.material].normalSlot;
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

#endif
