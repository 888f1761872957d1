#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "unit/gpu_case.h"

layout(local_size_x_id = 0) in;

// clang-format off
layout(push_constant, scalar) uniform Push { CounterArgs pc; };
// clang-format on

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CounterRef { uint items[]; };

void main() {
  const uint rounds = max(pc.rounds, 1u);
  for (uint i = 0u; i < rounds; ++i) atomicAdd(CounterRef(pc.counters).items[pc.index], 1u);
}
