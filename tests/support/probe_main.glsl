// The entry point of a GLSL probe: outputs[i] = probe(inputs[i]) for i < count. Include it after defining PROBE_INPUT
// and PROBE_OUTPUT, then define `PROBE_OUTPUT probe(const PROBE_INPUT c)`. `pc.extra` is the caller's own buffer
// address.
#ifndef ISOPHOTE_SUPPORT_PROBE_MAIN_GLSL
#define ISOPHOTE_SUPPORT_PROBE_MAIN_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(local_size_x_id = 0, local_size_y = 1, local_size_z = 1) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ProbeInputRef { PROBE_INPUT items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer ProbeOutputRef { PROBE_OUTPUT items[]; };

// clang-format off
layout(push_constant, scalar) uniform ProbePush {
  uint64_t inputs;
  uint64_t outputs;
  uint64_t extra;
  uint count;
} pc;
// clang-format on

PROBE_OUTPUT probe(const PROBE_INPUT c);

void main() {
  const uint index = gl_GlobalInvocationID.x;
  if (index >= pc.count) return;
  ProbeOutputRef(pc.outputs).items[index] = probe(ProbeInputRef(pc.inputs).items[index]);
}

#endif
