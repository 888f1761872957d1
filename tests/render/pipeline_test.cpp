// The wavefront and the fused kernel are two ways to the same bits, and may take turns in the middle of a render.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "isophote/features.hpp"
#include "render/paths_in_flight.hpp"
#include "support/cache_folder.hpp"
#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

struct Rendered {
  Image image;
  RenderStatistics statistics;
  SampleRange left;
};

struct Job {
  Scene scene;
  Camera camera;
  EstimatorSettings estimator{.filter = PixelFilter::Box, .seed = 1};
  FilmOptions film{.width = 20, .height = 13};
  std::vector<uint32_t> pixels;
  uint32_t samples = 8;
};

Rendered renderBy(const Job& job, const ExecutionSettings& execution) {
  const GpuScene scene(gpuDevice(), job.scene);
  Film film(gpuDevice(), job.film);
  PathTracer tracer(gpuDevice(), scene, job.estimator, execution);
  tracer.setPixels(job.pixels);
  tracer.render(job.camera, film, {0, job.samples});
  expectHealthy(tracer.statistics());
  return {film.resolve(), tracer.statistics(), tracer.left()};
}

void expectSameRays(const RenderStatistics& a, const RenderStatistics& b) {
  EXPECT_EQ(a.primaryRays, b.primaryRays);
  EXPECT_EQ(a.bounceRays, b.bounceRays);
  EXPECT_EQ(a.shadowRays, b.shadowRays);
}

void expectSameByBoth(const Job& job) {
  const Rendered wavefront = renderBy(job, {.pipeline = Pipeline::Wavefront});
  const Rendered fused = renderBy(job, {.pipeline = Pipeline::Fused});
  EXPECT_EQ(wavefront.statistics.fused.submits, 0u);
  EXPECT_EQ(fused.statistics.wavefront.submits, 0u);
  EXPECT_GT(fused.statistics.fused.submits, 0u);
  expectSameRays(wavefront.statistics, fused.statistics);
  EXPECT_TRUE(bitIdentical(wavefront.image, fused.image));
}

Material boundary(glm::vec3 attenuationColor, float ior) {
  Material material = dielectric(glm::vec3(1), 0);
  material.ior = ior;
  material.transmission.factor = 1;
  material.volume = {.thickness = 1, .attenuationColor = attenuationColor, .attenuationDistance = 0.5f};
  return material;
}

/// Textures, normal maps and alpha; fog in which colored glass stands; spheres that shine, so many that there is a
/// light tree; a sky: every stage has work.
Job everything() {
  Job job{.scene = texturedStillLife(), .camera = texturedStillLifeCamera()};
  Scene& scene = job.scene;
  Material fog = boundary({0.8f, 0.7f, 0.9f}, 1);
  fog.volume.multiscatterColor = {0.9f, 0.8f, 0.7f};
  const uint32_t glass = addMaterial(scene, boundary({0.3f, 0.9f, 0.8f}, 1.4f));
  const glm::dvec3 middle(0, 0, 0.5);
  addPrimitive(scene, sphere(1.2, 8, false, false, addMaterial(scene, fog)), glm::translate(glm::dmat4(1), middle));
  addPrimitive(scene, sphere(0.4, 8, false, false, glass), glm::translate(glm::dmat4(1), middle));
  for (int i = 0; i < 40; ++i) {
    PunctualLight light;
    light.kind = LightKind::Point;
    light.position = middle + glm::dvec3(std::cos(i), 0.5 + 0.02 * i, std::sin(i));
    light.radius = 0.02f;
    light.intensity = glm::vec3(0.05f);
    scene.lights.push_back(light);
  }
  return job;
}

TEST(Pipelines, AnEmptySceneIsTheSameByBoth) { expectSameByBoth({.scene = {}, .camera = {}}); }

TEST(Pipelines, BlendedLayersAreTheSameByBoth) {
  expectSameByBoth({.scene = alphaLayers(3, 0.4f), .camera = orthographicLookAt({0, 0, 3}, {}, 0.5, 0.5)});
}

// Half a minute of compilation.
TEST(PipelinesSlow, TheFusedKernelWithAllFeaturesGivesTheBitsOfTheSpecializedOne) {
  if (!gpuDevice().isCpu()) GTEST_SKIP() << "bit-identity of specialised kernels is promised for CPU devices only";
  const Job job = everything();
  EXPECT_TRUE(bitIdentical(renderBy(job, {.pipeline = Pipeline::Fused}).image,
                           renderBy(job, {.pipeline = Pipeline::Fused, .specialize = false}).image));
}

TEST(Pipelines, LimitsLedgersAndListsOfPixelsAreTheSameByBoth) {
  Job job{.scene = cornellBox(), .camera = cornellCamera()};
  job.estimator.maxDepth = 2;
  job.estimator.clamp = 0.5f;
  job.film.clampLedger = true;
  job.film.depthLedger = true;
  job.pixels = {0, 3, 5, 100, 101, 259};
  job.samples = 32;
  expectSameByBoth(job);
}

TEST(Pipelines, TheFusedKernelsPoolWorkgroupAndSubmitsChangeNoBit) {
  const Job job{.scene = cornellBox(), .camera = cornellCamera()};
  const Image expected = renderBy(job, {.pipeline = Pipeline::Wavefront}).image;
  for (const uint32_t pool : {3u, 100u, 4000u}) {
    for (const double submit : {0.5, 1000.0}) {
      SCOPED_TRACE(testing::Message() << "pool " << pool << ", submit " << submit);
      EXPECT_TRUE(bitIdentical(renderBy(job, {.pathPoolSize = pool,
                                              .workgroupSize = pool == 100 ? 32u : 0u,
                                              .pipeline = Pipeline::Fused,
                                              .submitMilliseconds = submit})
                                   .image,
                               expected));
    }
  }
}

// Handing over a pool of paths in flight loses none and renders none twice.
TEST(Pipelines, TakingTurnsChangesNoBit) {
  Job job = everything();
  const FeatureSet features = sceneFeatures(job.scene);
  for (const Feature feature : {Feature::kHasTextures, Feature::kHasEnvironment, Feature::kHasScatteringMedia,
                                Feature::kHasSphereLights, Feature::kHasLightTree}) {
    EXPECT_TRUE(features.has(feature)) << static_cast<uint32_t>(feature);
  }
  job.samples = 32;
  const Rendered turns =
      renderBy(job, {.pathPoolSize = 256, .pipeline = Pipeline::Auto, .compileShare = 1e9, .submitMilliseconds = 2});
  if (gpuDevice().isCpu()) {
    EXPECT_GT(turns.statistics.wavefront.submits, 4u);
    EXPECT_GT(turns.statistics.fused.submits, 4u);
  }
  const Rendered wavefront = renderBy(job, {.pipeline = Pipeline::Wavefront});
  expectSameRays(turns.statistics, wavefront.statistics);
  EXPECT_TRUE(bitIdentical(turns.image, wavefront.image));
}

// With an empty cache the search is under way all the time: submits are short enough for several counts to be tried.
TEST(Pipelines, SearchingForTheNumberOfPathsInFlightChangesNoBit) {
  const test::CacheFolder cache;
  Job job{.scene = cornellBox(), .camera = cornellCamera()};
  job.samples = 4096;
  const Image expected = renderBy(job, {.pathPoolSize = 1000, .pipeline = Pipeline::Wavefront}).image;
  for (const Pipeline pipeline : {Pipeline::Wavefront, Pipeline::Fused}) {
    SCOPED_TRACE(static_cast<uint32_t>(pipeline));
    const Rendered searched = renderBy(job, {.pipeline = pipeline, .submitMilliseconds = 20});
    EXPECT_TRUE(bitIdentical(searched.image, expected));
    if (!gpuDevice().isCpu()) continue; // too few samples for a GPU
    const PipelineStatistics& done =
        pipeline == Pipeline::Fused ? searched.statistics.fused : searched.statistics.wavefront;
    EXPECT_GT(done.submits, 10u); // two turns: the first rival had its own
    EXPECT_LE(done.pathsInFlight, pathsRange(gpuDevice(), pipeline).most);
    EXPECT_GE(done.pathsInFlight, pathsRange(gpuDevice(), pipeline).fewest);
  }
}

TEST(Pipelines, AFusedRenderThatWasStoppedGoesOnToTheSameBits) {
  const Job job{.scene = cornellBox(), .camera = cornellCamera(), .samples = 200};
  const GpuScene scene(gpuDevice(), job.scene);
  Film film(gpuDevice(), job.film);
  PathTracer tracer(gpuDevice(), scene, job.estimator,
                    {.pathPoolSize = 256, .pipeline = Pipeline::Fused, .submitMilliseconds = 0.5});
  int submits = 0;
  EXPECT_FALSE(tracer.render(job.camera, film, {0, job.samples}, [&](const Progress&) { return ++submits < 5; }));
  const SampleRange left = tracer.left();
  EXPECT_GT(left.first + left.begun, 0u);
  EXPECT_LT(left.first, job.samples);
  tracer.render(job.camera, film, left);
  expectHealthy(tracer.statistics());
  EXPECT_TRUE(bitIdentical(film.resolve(), renderBy(job, {.pipeline = Pipeline::Wavefront}).image));
}

} // namespace
} // namespace isophote
