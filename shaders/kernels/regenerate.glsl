// The start of a path: its pixel and sample, and a ray from the camera.
#ifndef ISOPHOTE_KERNELS_REGENERATE_GLSL
#define ISOPHOTE_KERNELS_REGENERATE_GLSL

#include "camera/camera.glsl"
#include "camera/pixel_filter.glsl"
#include "kernels/handover.glsl"
#include "kernels/wavefront.glsl"
#include "sampling/sampler.glsl"

// The crop pixel of a padded work index: tiles row by row, pixels within a tile row by row; or that of a list.
uvec2 tilePixel(const RenderRef render, const uint padded) {
  if (kPixelList != 0u) {
    const uint pixel = UintRef(render.view.pixels).items[padded];
    return uvec2(pixel % render.view.cropSize.x, pixel / render.view.cropSize.x);
  }
  const uvec2 tile = render.view.tileSize;
  const uint tileArea = tile.x * tile.y;
  const uint tileIndex = padded / tileArea;
  const uint inTile = padded % tileArea;
  return uvec2(tileIndex % render.view.tileColumns, tileIndex / render.view.tileColumns) * tile +
         uvec2(inTile % tile.x, inTile / tile.x);
}

/// Starts the path of a work item; its ray is handed over, and what only some scenes need of it stands in the pool.
///
/// @param item  counted from WaveState.regeneratePixel
/// @param path  out: as it starts; undefined where there is none
/// @return false for padding of a tile at the border of the crop: there is no such path
bool startPath(const uint slot, const uint item, out PathState path) {
  WaveRef wave = WaveRef(pc.wave);
  RenderRef render = RenderRef(pc.render);
  const uint offset = wave.state.regeneratePixel + item;
  const uint sampleIndex =
      render.view.firstSample + wave.state.regenerateSample + offset / render.view.paddedPixelCount;
  const uvec2 cropPixel = tilePixel(render, offset % render.view.paddedPixelCount);
  if (any(greaterThanEqual(cropPixel, render.view.cropSize))) return false;
  const uvec2 pixel = render.view.cropOrigin + cropPixel;
  const SampleKey key = SampleKey(pixel.x | pixel.y << 16u, sampleIndex, render.view.seed);
  const vec2 offsetInPixel = sampleFilter(FloatRef(render.view.filterTable), sample2d(key, 0u));
  const vec2 uLens = kHasThinLens ? sample2d(key, 1u) : vec2(0.0);
  const CameraRay ray =
      cameraRay(render.view.camera, vec2(pixel) + 0.5 + offsetInPixel, vec2(render.view.imageSize), uLens);

  handRay(slot, RayState(ray.origin, ray.tMin, ray.direction, ray.tMax));
  path = PathState(vec3(1.0), 0.0, vec3(0.0), 0u, key.pixel, sampleIndex, 0u);
  if (kHasVolumes) {
    const MediumStack around = render.view.cameraMedia;
    MediaRef(pc.media).items[slot] = MediaState(around, around, 0.0, 0.0, 0u);
  }
  if (kHasTransmission) InteriorRef(pc.interiors).items[slot] = InteriorState(1.0, 0u);
  if (kStraightShadows) StraightRef(pc.straight).items[slot] = StraightState(0.0, kStraightNone);
  if (kDepthLedger != 0u) BeyondRef(render.view.beyondPaths).items[slot].reached = 0u;
  return true;
}

#endif
