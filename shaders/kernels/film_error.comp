// Partial sums of the image's error estimate: each invocation takes every kErrorInvocations-th pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "film/pixel_mean.glsl"

layout(local_size_x_id = 0) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer PartialRef { ErrorPartial items[]; };

// clang-format off
layout(push_constant, scalar) uniform PushConstant { FilmArgs pc; };
// clang-format on

void main() {
  const uint invocation = gl_GlobalInvocationID.x;
  if (invocation >= kErrorInvocations) return;
  ErrorPartial partial = ErrorPartial(0.0, 0.0, 0.0, 0.0, 0u, 0u);
  for (uint pixel = invocation; pixel < pc.pixelCount; pixel += kErrorInvocations) {
    const PixelMean m = pixelMean(ReplicateRef(pc.replicates), pixel, pc.valueScale);
    partial.luminance += dot(m.mean, vec3(0.2126, 0.7152, 0.0722));
    if (m.replicates < 2u) continue;
    const vec3 terms = m.varianceOfMean / (m.mean * m.mean + pc.epsilonSquare);
    const float term = terms.x + terms.y + terms.z;
    partial.relativeSquare += term;
    partial.termSquare += term * term;
    if (m.replicates == kReplicateCount && m.largestShare > kTrustedShare) {
      partial.untrusted += term;
      partial.untrustedCount += 1u;
    }
    partial.pixelCount += 1u;
  }
  PartialRef(pc.target).items[invocation] = partial;
}
