// The media around the camera: each invocation follows one straight line out of the scene. Volumes that it leaves
// without having entered them are those the camera is in. The host takes the most frequent answer, so that a few lines
// through edges or holes do no harm.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "geometry/surface.glsl"
#include "geometry/traverse.glsl"
#include "kernels/wavefront.glsl"
#include "medium/medium_stack.glsl"
#include "sampling/hash.glsl"
#include "sampling/warp.glsl"

// Surfaces on one line; what lies beyond is not looked at.
const uint kMostSurfaces = 4096u;

// Puts a material under the others, for what is found later lies further out; the outermost is lost where four are not
// enough.
MediumStack putUnder(const MediumStack stack, const uint material) {
  return MediumStack(uint[](material, stack.materials[0], stack.materials[1], stack.materials[2]));
}

void main() {
  const uint line = gl_GlobalInvocationID.x;
  if (line >= pc.capacity) return;
  SceneRef scene = SceneRef(pc.scene);
  const vec2 u = vec2(fract((float(line) + 0.5) * 0.6180339887), (float(line) + 0.5) / float(pc.workgroupSize));
  const vec3 direction = sampleUniformSphere(u);
  vec3 origin = RenderRef(pc.render).view.camera.position;
  MediumStack around = noMedia();
  MediumStack entered = noMedia();
  for (uint i = 0u; i < kMostSurfaces; ++i) {
    const RayHit hit =
        traceClosest(scene, origin, direction, 0.0, kRayInfinity, AlphaKey(0u, line, uvec2(0u), 0u), kInvalidIndex);
    if (!hit.found || hit.triangle == kInvalidIndex) break; // out of the scene, or at a sphere light
    const SurfaceHit surface = surfaceAt(scene, hit.instance, hit.triangle, hit.barycentrics, -direction);
    origin = offsetRayOrigin(surface.p, surface.pError, surface.ng, direction);
    if (!isVolumeBoundary(scene, surface.material)) continue;
    if (surface.frontFace) {
      entered = enterMedium(entered, surface.material);
    } else if (contains(entered, surface.material)) {
      entered = leaveMedium(entered, surface.material);
    } else if (!isFull(around)) {
      around = putUnder(around, surface.material);
    }
  }
  MediaRef(pc.media).items[line].path = around;
}
