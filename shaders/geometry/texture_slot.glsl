// Texture reads by slot. The one place that declares the texture array.
#ifndef ISOPHOTE_GEOMETRY_TEXTURE_SLOT_GLSL
#define ISOPHOTE_GEOMETRY_TEXTURE_SLOT_GLSL

#extension GL_EXT_nonuniform_qualifier : require

#include "geometry/attributes.glsl"

layout(set = 0, binding = 0) uniform sampler2D textures[];

/// The centre of the texel that holds uv: there every filter gives that texel alone.
vec2 texelCentre(const uint index, const vec2 uv) {
  const vec2 size = vec2(textureSize(textures[nonuniformEXT(index)], 0));
  return (floor(uv * size) + 0.5) / size;
}

/// The texel of slot `slot` at a point of a triangle, level 0, decoded to linear; `fallback` where there is no slot.
/// @param slot  index into the TextureSlot array, or kInvalidIndex
vec4 readSlot(const SceneRef scene, const Geometry geometry, const uint primitiveIndex, const vec2 barycentrics,
              const uint slot, const vec4 fallback) {
  if (kHasTextures) {
    if (slot != kInvalidIndex) {
      const TextureSlot use = TextureSlotRef(scene.view.textureSlots).items[slot];
      const vec3 uv = vec3(interpolateUv(scene, geometry, primitiveIndex, barycentrics, use.uvSet), 1.0);
      vec2 at = vec2(dot(use.uRow, uv), dot(use.vRow, uv));
      if (kTextureFilter == 1u) at = texelCentre(use.texture, at);
      return textureLod(textures[nonuniformEXT(use.texture)], at, 0.0);
    }
  }
  return fallback;
}

#endif
