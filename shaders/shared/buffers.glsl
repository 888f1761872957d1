// Typed device addresses of everything SceneView points at. Usage: GeometryRef(scene.view.geometries).items[i].
#ifndef ISOPHOTE_BUFFERS_GLSL
#define ISOPHOTE_BUFFERS_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "shared/geometry_types.h"
#include "shared/light_types.h"
#include "shared/material_types.h"
#include "shared/scene_view.h"

#define ISOPHOTE_BUFFER(Name, Type)                                                                                    \
  layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Name { Type items[]; }

// The scene travels through functions as this 8-byte pointer: `const SceneRef scene`, read as scene.view.member.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer SceneRef { SceneView view; };

ISOPHOTE_BUFFER(FloatRef, float);
ISOPHOTE_BUFFER(UintRef, uint);
ISOPHOTE_BUFFER(Vec2Ref, vec2);
ISOPHOTE_BUFFER(Vec3Ref, vec3);
ISOPHOTE_BUFFER(Vec4Ref, vec4);
// One BvhNode as 8-byte words: a CPU driver gathers component by component, 8 bytes as fast as 4.
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer BvhNodeRef { uint64_t words[10]; };
ISOPHOTE_BUFFER(BvhTriangleRef, BvhTriangle);
ISOPHOTE_BUFFER(InstanceRef, InstanceRecord);
ISOPHOTE_BUFFER(GeometryRef, Geometry);
ISOPHOTE_BUFFER(MaterialRef, MaterialRecord);
ISOPHOTE_BUFFER(TextureSlotRef, TextureSlot);
ISOPHOTE_BUFFER(AliasRef, AliasEntry);
ISOPHOTE_BUFFER(LightTreeRef, LightTreeNode);
ISOPHOTE_BUFFER(EmissiveTriangleRef, EmissiveTriangle);
ISOPHOTE_BUFFER(PunctualLightRef, PunctualLightRecord);

#endif
