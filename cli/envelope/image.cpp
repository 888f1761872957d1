// Texture size, samples per pixel, and resolution.
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "envelope/scene_parts.hpp"
#include "envelope/sweep.hpp"
#include "isophote/error.hpp"
#include "isophote/path_tracer.hpp"

namespace isophote::envelope {
namespace {

constexpr uint32_t kLargestSide = 65535;

/// One white texel, near the end of a row of black ones, over two texels' width: a half, read linearly.
Case texture(double size) {
  const auto count = static_cast<uint32_t>(size);
  Case c;
  ImageData image;
  image.width = count;
  image.height = 2;
  image.pixels.assign(size_t{8} * count, std::byte(0));
  const uint32_t bright = count < 4 ? 0 : count - 2;
  for (const uint32_t row : {0u, 1u}) std::memset(image.pixels.data() + 4 * (size_t{row} * count + bright), 255, 4);
  c.scene.images.push_back(std::move(image));
  c.scene.textures.push_back({.image = 0});
  Material material = emitter(glm::vec3(1));
  material.emissiveTexture = useTexture(0);
  Primitive wall = facingQuad(1, 1, addMaterial(c.scene, material));
  addPrimitive(c.scene, wall);
  const double texel = 2.0 / count;
  const double x = -1 + (bright + 0.5) * texel;
  c.camera = orthographicLookAt({x, 0, 1}, {x, 0, 0}, count < 4 ? 1 : texel, count < 4 ? 1 : texel);
  c.exact = count < 4 ? 1.0 / count : 0.5;
  return c;
}

/// The limits of one pixel: a constant sky of 0.1.
Case constantSky(double samples) {
  Case c{.camera = lookAt({}, {0, 0, -1}, 0.8), .width = 1, .height = 1};
  c.scene.environment = constantEnvironment(glm::vec3(0.1f));
  c.exact = static_cast<double>(0.1f);
  c.fewestSamples = c.mostSamples = static_cast<uint32_t>(samples);
  if (samples < 16) c.width = c.height = 8; // pixels are each other's error bar
  return c;
}

/// One film added to itself until a pixel holds so many samples, as merging adds shards.
Point accumulated(const Device& device, double samples) {
  Point point{.value = samples};
  constexpr uint32_t kBegin = 1 << 12;
  Case c = constantSky(kBegin);
  try {
    const GpuScene scene(device, c.scene);
    Film film(device, {.width = 1, .height = 1, .aovs = false});
    PathTracer tracer(device, scene, c.estimator);
    tracer.render(c.camera, film, {0, kBegin});
    FilmSums sums = film.sums();
    double count = kBegin;
    for (; count < samples; count *= 2) {
      const FilmSums half = sums;
      addSums(sums, half);
    }
    film.restore(sums);
    const Image image = film.resolve();
    point.samples = static_cast<uint64_t>(count);
    point.error = static_cast<double>(image.find("G")->values[0]) / c.exact - 1;
    if (const double held = static_cast<double>(image.find("sampleCount.Y")->values[0]); held != count)
      point.failure = fmt::format("{} samples counted", held);
  } catch (const Error& error) {
    point.failure = error.what();
  }
  return point;
}

/// The last pixels of a square image, a third of one column covered by a lamp.
Case edge(double side) {
  const auto size = static_cast<uint32_t>(side);
  Case c{.camera = orthographicLookAt({0, 0, 1}, {0, 0, 0}, 1, 1), .width = size, .height = size};
  const double pixel = 2.0 / size;
  const uint32_t shown = std::min(size, 4u);
  // From the right border inwards; the column next to the innermost shown is covered by 0.3.
  const auto left = static_cast<float>(1 - (shown - 1 + 0.3) * pixel);
  addPrimitive(c.scene, quad({left, -2, 0}, {4, 0, 0}, {0, 4, 0}, addMaterial(c.scene, emitter(glm::vec3(1)))));
  c.crop = {size - shown, size - shown, size, size};
  c.exact = (1 - static_cast<double>(left)) / pixel / shown;
  // Relative to one pixel's column: what is off by a hundredth of a pixel shows as one percent.
  c.scale = 1.0 / shown;
  c.mostSamples = 1 << 16;
  return c;
}

} // namespace

void addImageSweeps(std::vector<Sweep>& sweeps) {
  sweeps.push_back({"texture",
                    "texels in a row",
                    "One white texel among black ones, seen from up close: a half",
                    {1, 4, 64, 1024, 4096, 8192, 16384},
                    64,
                    texture});
  sweeps.push_back({"samples",
                    "samples per pixel",
                    "A sky of 0.1: 0.1",
                    {1, 16, 256, 4096, 65536, 1 << 20, 1 << 23, 1 << 26},
                    16,
                    constantSky});
  sweeps.back().slow = {1 << 23, 1 << 26};
  Sweep accumulation{"accumulation",
                     "samples per pixel",
                     "A sky of 0.1, a film added to itself: 0.1",
                     {4096, 1 << 20, 1 << 26, 1 << 28, 1 << 30, 0x1p31, 0x1p32, 0x1p33, 0x1p34},
                     4096,
                     {}};
  accumulation.measured = accumulated;
  sweeps.push_back(accumulation);
  sweeps.push_back({"resolution",
                    "pixels on a side",
                    "A lamp's edge at 0.3 of a pixel, in the last pixels of the image; relative to that pixel",
                    {1, 16, 256, 1024, 4096, 16384, 32768, kLargestSide},
                    256,
                    edge});
}

} // namespace isophote::envelope
