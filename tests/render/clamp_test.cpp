// The clamp: what it removes is accounted for, to the last bit that rounding leaves.
#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

Image renderClamped(const Scene& scene, const Camera& camera, float clamp, uint32_t samples, bool ledger = true) {
  const GpuScene gpuScene(gpuDevice(), scene);
  Film film(gpuDevice(), {.width = 12, .height = 12, .aovs = false, .clampLedger = ledger});
  PathTracer tracer(gpuDevice(), gpuScene, {.filter = PixelFilter::Box, .clamp = clamp, .seed = 1});
  tracer.render(camera, film, {0, samples});
  expectHealthy(tracer.statistics());
  return film.resolve();
}

TEST(Clamp, ScalesASampleDownByItsBrightestChannel) {
  Scene scene;
  scene.environment = constantEnvironment({0.5f, 0.25f, 0.1f});
  const Image image = renderClamped(scene, lookAt({}, {0, 0, -1}, 0.8), 0.2f, 16);
  const auto expectPlane = [&](const char* name, float expected) {
    for (const float value : plane(image, name)) ASSERT_NEAR(value, expected, 1e-6) << name;
  };
  expectPlane("R", 0.2f);
  expectPlane("G", 0.1f);
  expectPlane("B", 0.04f);
  expectPlane("clamped.R", 0.3f);
  expectPlane("clamped.G", 0.15f);
  expectPlane("clamped.B", 0.06f);
}

// The same samples with and without: pixel by pixel, what is kept and what is removed make the whole.
TEST(Clamp, KeptAndRemovedAreTheUnclampedImage) {
  const Image whole = renderClamped(cornellBox(), cornellCamera(), kNoClamp, 64);
  const Image clamped = renderClamped(cornellBox(), cornellCamera(), 0.5f, 64);
  double removed = 0;
  for (const std::string color : {"R", "G", "B"}) {
    const auto expected = plane(whole, color), kept = plane(clamped, color), lost = plane(clamped, "clamped." + color);
    for (size_t i = 0; i < expected.size(); ++i) {
      ASSERT_NEAR(kept[i] + lost[i], expected[i], 1e-5 * expected[i] + 1e-9) << color << i;
      ASSERT_GE(lost[i], 0);
      removed += double(lost[i]);
    }
    for (const float none : plane(whole, "clamped." + color)) ASSERT_EQ(none, 0);
  }
  EXPECT_GT(removed, 0);
}

TEST(Clamp, BeyondTheBrightestSampleChangesNoBit) {
  const Image off = renderClamped(cornellBox(), cornellCamera(), kNoClamp, 8);
  EXPECT_TRUE(bitIdentical(off, renderClamped(cornellBox(), cornellCamera(), 1e6f, 8)));
}

TEST(Clamp, RefusesALimitOfNothing) {
  const GpuScene scene(gpuDevice(), cornellBox());
  EXPECT_THROW(PathTracer(gpuDevice(), scene, {.clamp = 0}), UsageError);
}

} // namespace
} // namespace isophote
