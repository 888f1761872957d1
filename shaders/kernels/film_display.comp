// Film -> tone-mapped RGBA8, for a viewer.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "film/pixel_mean.glsl"
#include "film/tone_map.glsl"

layout(local_size_x_id = 0) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer DisplayRef { uint pixels[]; };

// clang-format off
layout(push_constant, scalar) uniform PushConstant { FilmArgs pc; };
// clang-format on

void main() {
  const uint pixel = gl_GlobalInvocationID.x;
  if (pixel >= pc.pixelCount) return;
  const PixelMean m = pixelMean(ReplicateRef(pc.replicates), pixel, pc.valueScale);
  const vec3 display = toneMap(m.mean * pc.exposure, pc.toneMap);
  DisplayRef(pc.target).pixels[pixel] = packUnorm4x8(vec4(display, 1.0));
}
