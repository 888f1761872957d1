#include "support/render.hpp"

#include <bit>

#include <fmt/format.h>

#include "support/gpu_device.hpp"

namespace isophote::test {

void expectHealthy(const RenderStatistics& statistics) {
  const StatusCounters& status = statistics.status;
  EXPECT_EQ(status.queueOverflow, 0u);
  EXPECT_EQ(status.stackOverflow, 0u);
  EXPECT_EQ(status.nonFinite, 0u);
  EXPECT_EQ(status.negative, 0u);
  EXPECT_EQ(status.clipped, 0u);
  EXPECT_EQ(status.outOfBounds, 0u);
  EXPECT_EQ(status.mediumOverflow, 0u);
}

Image renderImage(const Scene& scene, const Camera& camera, uint32_t width, uint32_t height, uint32_t samplesPerPixel,
                  const RenderOptions& options) {
  const Device& device = gpuDevice();
  const GpuScene gpuScene(device, scene);
  Film film(device, {.width = width, .height = height, .crop = options.crop});
  PathTracer tracer(device, gpuScene, options.estimator, options.execution);
  if (options.ranges.empty()) {
    tracer.render(camera, film, {0, samplesPerPixel});
  } else {
    for (const SampleRange& range : options.ranges) tracer.render(camera, film, range);
  }
  expectHealthy(tracer.statistics());
  return film.resolve();
}

std::vector<float> plane(const Image& image, const std::string& name) {
  const Channel* channel = image.find(name);
  const size_t size = size_t{image.width} * image.height;
  if (channel != nullptr && channel->values.size() == size) return channel->values;
  ADD_FAILURE() << "no plane " << name << " of " << size << " values";
  return std::vector<float>(size);
}

testing::AssertionResult bitIdentical(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels.size() != b.channels.size())
    return testing::AssertionFailure() << "sizes or numbers of planes differ";
  for (size_t c = 0; c < a.channels.size(); ++c) {
    const Channel &first = a.channels[c], &second = b.channels[c];
    if (first.name != second.name || first.values.size() != second.values.size())
      return testing::AssertionFailure() << "plane " << c << ": " << first.name << " against " << second.name;
    for (size_t i = 0; i < first.values.size(); ++i) {
      if (std::bit_cast<uint32_t>(first.values[i]) == std::bit_cast<uint32_t>(second.values[i])) continue;
      return testing::AssertionFailure() << first.name << " at pixel " << i % a.width << "," << i / a.width << ": "
                                         << fmt::format("{} against {}", first.values[i], second.values[i]);
    }
  }
  return testing::AssertionSuccess();
}

} // namespace isophote::test
