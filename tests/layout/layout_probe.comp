// Never run: its SPIR-V tells where the GLSL compiler puts each member of each shared struct in scalar layout.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "shared/camera_types.h"
#include "shared/film_types.h"
#include "shared/geometry_types.h"
#include "shared/light_types.h"
#include "shared/material_types.h"
#include "shared/path_types.h"
#include "shared/scene_view.h"

layout(local_size_x = 1) in;

#define SHARED_STRUCT(Name, members)                                                                                   \
  layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Name##Array { Name items[]; };
#include "layout/layout_structs.inc"
#undef SHARED_STRUCT

// clang-format off
layout(push_constant, scalar) uniform Push { uint64_t address; } pc;
// clang-format on

void main() {
  // The compiler drops the type of a buffer that nothing reads.
#define SHARED_STRUCT(Name, members) Name##Array(pc.address).items[0] = Name##Array(pc.address).items[1];
#include "layout/layout_structs.inc"
#undef SHARED_STRUCT
}
