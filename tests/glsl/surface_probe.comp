#version 460
#extension GL_GOOGLE_include_directive : require

#include "geometry/surface.glsl"
#include "glsl/surface_case.h"
#define PROBE_INPUT SurfaceCase
#define PROBE_OUTPUT SurfaceResult
#include "support/probe_main.glsl"

SurfaceResult probe(const SurfaceCase c) {
  SceneRef scene = SceneRef(pc.extra);
  const SurfaceHit s = surfaceAt(scene, c.instance, c.triangle, c.barycentrics);
  const SurfaceHit seen = surfaceAt(scene, c.instance, c.triangle, c.barycentrics, c.wo);
  const Geometry geometry = GeometryRef(scene.view.geometries).items[s.geometry];
  const uint mesh = InstanceRef(scene.view.instances).items[s.instance].mesh;
  return SurfaceResult(s.p, s.pError, s.ng, s.ns, s.tangent, s.material, s.geometry, s.primitiveIndex, mesh, s.flags,
                       s.area, seen.ng, seen.ns, seen.frontFace ? 1u : 0u,
                       interpolateColor(scene, geometry, s.primitiveIndex, c.barycentrics),
                       interpolateUv(scene, geometry, s.primitiveIndex, c.barycentrics, 0u),
                       interpolateUv(scene, geometry, s.primitiveIndex, c.barycentrics, 1u));
}
