// The addresses of everything a scene owns on the device.
#ifndef ISOPHOTE_SHARED_SCENE_VIEW_H
#define ISOPHOTE_SHARED_SCENE_VIEW_H

#include "glsl_compat.h"
#include "light_types.h"

ISOPHOTE_SHARED_BEGIN

struct SceneView {
  Address nodes;             // BvhNode: top level first, root at 0
  Address triangles;         // BvhTriangle
  Address instances;         // InstanceRecord, in top-level leaf order
  Address geometries;        // Geometry
  Address indices;           // uint
  Address normals;           // vec3
  Address tangents;          // vec4
  Address colors;            // vec4
  Address uvs;               // vec2
  Address materials;         // MaterialRecord
  Address textureSlots;      // TextureSlot
  Address lightAlias;        // AliasEntry, one per light
  Address lightTree;         // LightTreeNode, root first; 0: the scene has few lights
  Address lightTrails;       // uint, one per light: bit d is the child to take at depth d of the tree
  Address emissiveTriangles; // EmissiveTriangle
  Address punctualLights;    // PunctualLightRecord
  Address facetAlbedo;       // vec2 table of bsdf/facet_albedo.glsl
  Address anisotropicAlbedo; // vec2 tables of bsdf/anisotropic_albedo.glsl
  Address glassLoss;         // vec2 tables of bsdf/glass_loss.glsl
  Address clearcoatTable;    // float table of bsdf/layer.glsl
  Address sheenTable;        // the same of the sheen
  Address coatedSheenTable;  // vec4 table of bsdf/coated_sheen.glsl
  Address filmAlbedo;        // vec3 tables of bsdf/film_albedo.glsl
  Address topLevel;          // acceleration structure of the device, in place of `nodes`; 0: there is none
  Address rangeStarts;       // uint, per geometry of its bottom levels: the first in `triangles`
  EnvironmentRecord environment;
  uint lightCount;
  uint emissiveTriangleCount;
  uint punctualLightCount; // suns included
  uint sunCount;           // the first of them
  uint instanceCount;
  float lightTreeScale;
  float emitterScale; // PackedScene::emitterScale: the Film's fixed point follows it
};

ISOPHOTE_SHARED_END

#endif
