// Scenes with closed forms, crossed over every way to sample lights, both sources of random numbers, and, where there
// are several lights, every way to choose one. A few of the crossings run by default to 3%; all of them, to 0.3%, are
// slow.
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <gtest/gtest.h>

#include "isophote/gpu_scene.hpp"
#include "isophote/path_tracer.hpp"
#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr double kPi = 3.14159265358979323846;

struct AnalyticScene {
  const char* name;
  Scene scene;
  Camera camera;
  double radiance; ///< of green in every pixel
  uint32_t maxDepth = kUnlimitedDepth;
  bool manyLights = false;
  bool lightsAloneDiverge = false; ///< emitters touch receivers: sampling by area alone has no finite variance
};

/// Two unit squares face each other in a tube of perfect mirrors (number 27 of the reliability list). One emits 1, they
/// reflect 0.5 and 0.8: radiances 5/3 and 4/3, the solution of two equations. The camera sees the second.
AnalyticScene platesInMirrorTube() {
  Scene scene;
  const uint32_t bright = addMaterial(scene, emitter(glm::vec3(1), glm::vec3(0.5f)));
  const uint32_t dull = addMaterial(scene, lambert(glm::vec3(0.8f)));
  const uint32_t mirror = addMaterial(scene, metal(glm::vec3(1), 0));
  addPrimitive(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, bright));   // faces +z
  addPrimitive(scene, quad({0, 0, 1.5}, {0, 1, 0}, {1, 0, 0}, dull));   // faces -z
  addPrimitive(scene, quad({0, 0, 0}, {0, 0, 1.5}, {1, 0, 0}, mirror)); // the tube
  addPrimitive(scene, quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1.5}, mirror));
  addPrimitive(scene, quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1.5}, mirror));
  addPrimitive(scene, quad({1, 0, 0}, {0, 0, 1.5}, {0, 1, 0}, mirror));
  return {"MirrorTube", std::move(scene), lookAt({0.4, 0.6, 0.5}, {0.5, 0.5, 1.5}, 0.3), 4.0 / 3};
}

/// A disk of radius R at height 1 over the sensor, as a fan of triangles of the same area (number 23): irradiance
/// pi R^2 / (R^2 + 1). A fan of 256 is off by less than 1e-4.
AnalyticScene disk(const char* name, double radius) {
  constexpr int kCorners = 256;
  const double corner = radius * std::sqrt(2 * kPi / kCorners / std::sin(2 * kPi / kCorners));
  Scene scene = lambertFloor(glm::vec3(1), 2);
  Primitive fan;
  fan.material = addMaterial(scene, emitter(glm::vec3(1)));
  fan.positions.emplace_back(0, 1, 0);
  for (uint32_t i = 0; i < kCorners; ++i) {
    const double phi = 2 * kPi * i / kCorners;
    fan.positions.emplace_back(corner * std::cos(phi), 1, corner * std::sin(phi));
    fan.indices.insert(fan.indices.end(), {0, 1 + i, 1 + (i + 1) % kCorners}); // faces down
  }
  addPrimitive(scene, fan);
  AnalyticScene result{name, std::move(scene), sensorAt({0, 0, 0}), radius * radius / (radius * radius + 1), 1};
  result.manyLights = true;
  return result;
}

AnalyticScene withFloor(const char* name, const PunctualLight& light, double irradiance) {
  Scene scene = lambertFloor(glm::vec3(1), 2);
  scene.lights.push_back(light);
  return {name, std::move(scene), sensorAt({0, 0, 0}), irradiance / kPi, 1};
}

AnalyticScene halfSky() { return {"HalfSky", floorUnderAHalfBrightSky(), sensorAt({0, 0, 0}), 0.5 * 2, 1}; }

/// Panes of glass before a wide emitter (numbers 30 and 31), seen at an angle from their normal.
AnalyticScene panes(uint32_t count, double degrees, double expected) {
  constexpr double kHalf = 1e3;
  Scene scene;
  const uint32_t clear = addMaterial(scene, glass(0));
  for (uint32_t i = 0; i < count; ++i)
    addPrimitive(scene, box({-kHalf, 2.0 * i + 1, -kHalf}, {kHalf, 2.0 * i + 2, kHalf}, false, clear));
  addPrimitive(scene, quad({-kHalf, 0, kHalf}, {2 * kHalf, 0, 0}, {0, 0, -2 * kHalf},
                           addMaterial(scene, emitter(glm::vec3(1)))));
  const glm::dvec3 target(0, 2.0 * count, 0);
  const double angle = degrees * kPi / 180;
  const glm::dvec3 from(std::sin(angle), std::cos(angle), 1e-3);
  return {"Pane", std::move(scene), orthographicLookAt(target + 3.0 * from, target, 0.5, 0.5), expected};
}

/// Six points, three directions, three suns and a hundred triangles: the sum of their irradiances.
AnalyticScene lamps() {
  Scene scene = lambertFloor(glm::vec3(1), 2);
  double irradiance = 0;
  const uint32_t glow = addMaterial(scene, emitter(glm::vec3(4)));
  for (int i = 0; i < 50; ++i) { // small squares that face the sensor: L A cos / d^2
    const double phi = 2 * kPi * i / 50, height = 0.3 + 0.012 * i, d = 2 + 0.1 * (i % 7), size = 0.02;
    const glm::dvec3 along(std::sqrt(1 - height * height) * std::cos(phi), height,
                           std::sqrt(1 - height * height) * std::sin(phi));
    const glm::dvec3 u = glm::normalize(glm::cross(along, glm::dvec3(0, 1, 0))), v = glm::cross(along, u);
    addPrimitive(scene, quad(d * along - 0.5 * size * (u + v), size * v, size * u, glow));
    irradiance += 4 * size * size * height / (d * d);
  }
  for (int i = 0; i < 6; ++i) {
    PunctualLight point;
    point.position = {0.4 * i - 1, 3, 0.2 * i};
    point.intensity = glm::vec3(0.1f * static_cast<float>(i + 1));
    const double d = glm::length(point.position);
    irradiance += double(point.intensity.g) * 3 / (d * d * d);
    scene.lights.push_back(point);
    PunctualLight sun;
    sun.kind = LightKind::Directional;
    sun.direction = glm::normalize(glm::dvec3(0.2 * i, -1, 0));
    sun.intensity = glm::vec3(0.02f);
    sun.radius = i % 2 == 0 ? 0.0f : 0.05f;
    irradiance += double(sun.intensity.g) * -sun.direction.y;
    scene.lights.push_back(sun);
  }
  AnalyticScene result{"Lamps", std::move(scene), sensorAt({0, 0, 0}), irradiance / kPi, 1};
  result.manyLights = true;
  return result;
}

AnalyticScene furnace() {
  AnalyticScene result{"Furnace", boxFurnace(glm::vec3(1), glm::vec3(0.5f)), boxFurnaceCamera(), 2};
  result.lightsAloneDiverge = true;
  return result;
}

AnalyticScene blendedSheets() {
  Scene scene = alphaLayers(2, 0.5f);
  return {"Sheets", std::move(scene), orthographicLookAt({0, 0, 2}, {0, 0, 0}, 0.9, 0.9), 0.25};
}

PunctualLight pointLight(glm::dvec3 position, float intensity, float radius) {
  PunctualLight light;
  light.position = position;
  light.intensity = glm::vec3(intensity);
  light.radius = radius;
  return light;
}

/// Named once, so that the suites below can be listed without building every scene.
struct SceneMaker {
  const char* name;
  bool manyLights;
  std::function<AnalyticScene()> make;
};

const std::vector<SceneMaker>& sceneMakers() {
  static const std::vector<SceneMaker> makers = {
      {"Furnace", false, furnace},
      {"Square", false,
       [] {
         return AnalyticScene{"Square", squareLightOverFloor(2), sensorAt({0, 0, 0}), 2 * 0.2394564705, 1};
       }},
      {"Disk", true, [] { return disk("Disk", 1); }},
      {"Sphere", false,
       [] {
         return withFloor("Sphere", pointLight({0, 2, 0}, static_cast<float>(kPi), 1), 0.785398163);
       }},
      {"Point", false,
       [] {
         return withFloor("Point", pointLight({1, 2, 0}, 3, 0), 3 * 2 / std::pow(5, 1.5));
       }},
      {"HalfSky", false, halfSky},
      {"MirrorTube", false, platesInMirrorTube},
      {"Pane", false, [] { return panes(1, 60, 0.836232); }},
      {"Sheets", false, blendedSheets},
      {"Lamps", true, lamps},
  };
  return makers;
}

enum class Lights { MisPower, MisBalance, LightsOnly, BsdfOnly };

struct Crossing {
  size_t scene = 0;
  Lights lights = Lights::MisPower;
  SamplerKind sampler = SamplerKind::Sobol;
  LightSelection selection = LightSelection::Bvh;

  [[nodiscard]] EstimatorSettings settings(uint32_t maxDepth) const {
    EstimatorSettings settings{.sampler = sampler, .filter = PixelFilter::Box, .maxDepth = maxDepth, .seed = 2026};
    settings.lightSelection = selection;
    settings.misHeuristic = lights == Lights::MisBalance ? MisHeuristic::Balance : MisHeuristic::Power;
    if (lights == Lights::LightsOnly) settings.lightSampling = LightSampling::LightsOnly;
    if (lights == Lights::BsdfOnly) settings.lightSampling = LightSampling::BsdfOnly;
    return settings;
  }
};

std::string crossingName(const testing::TestParamInfo<Crossing>& info) {
  const char* const lights[] = {"MisPower", "MisBalance", "LightsOnly", "BsdfOnly"};
  const char* const samplers[] = {"Sobol", "Independent"};
  const char* const selections[] = {"Uniform", "ByPower", "Tree"};
  const Crossing& c = info.param;
  std::string name = sceneMakers()[c.scene].name;
  name += lights[static_cast<size_t>(c.lights)];
  name += samplers[static_cast<size_t>(c.sampler)];
  if (sceneMakers()[c.scene].manyLights) name += selections[static_cast<size_t>(c.selection)];
  return name;
}

std::vector<Crossing> allCrossings() {
  std::vector<Crossing> result;
  for (size_t scene = 0; scene < sceneMakers().size(); ++scene) {
    for (const auto lights : {Lights::MisPower, Lights::MisBalance, Lights::LightsOnly, Lights::BsdfOnly}) {
      for (const auto sampler : {SamplerKind::Sobol, SamplerKind::Independent}) {
        for (const auto selection : {LightSelection::Bvh, LightSelection::Power, LightSelection::Uniform}) {
          if (selection == LightSelection::Bvh || sceneMakers()[scene].manyLights)
            result.push_back({scene, lights, sampler, selection});
        }
      }
    }
  }
  return result;
}

/// Every scene once, every value of every setting more than once.
std::vector<Crossing> someCrossings() {
  std::vector<Crossing> result;
  for (size_t scene = 0; scene < sceneMakers().size(); ++scene) {
    std::vector<Crossing> ofScene = allCrossings();
    std::erase_if(ofScene, [&](const Crossing& c) { return c.scene != scene; });
    result.push_back(ofScene[(5 * scene + 1) % ofScene.size()]);
  }
  return result;
}

constexpr uint32_t kPilot = 256, kSide = 8;

/// The mean over the pixels is `radiance` by t-test over the pixels, which are independent replicates. A pilot of 256
/// samples says how many more the half-width of the interval, 4.9 standard errors, needs to fall below the floor; they
/// are fresh ones. All tests of the cross together fail by chance once in a thousand.
void expectRadiance(const AnalyticScene& analytic, const Crossing& crossing, double floor) {
  const GpuScene gpuScene(gpuDevice(), analytic.scene);
  PathTracer tracer(gpuDevice(), gpuScene, crossing.settings(analytic.maxDepth));
  const double significance = sidak(kFamilySignificance, allCrossings().size());
  const auto pixels = [&](SampleRange range) {
    Film film(gpuDevice(), {.width = kSide, .height = kSide});
    tracer.render(analytic.camera, film, range);
    Moments result;
    for (const float value : plane(film.resolve(), "G")) result.add(value);
    return result;
  };
  const double quantile = studentTwoSidedQuantile(significance, kSide * kSide - 1);
  const double wanted = floor * analytic.radiance;
  const double pilotHalfWidth = quantile * pixels({0, kPilot}).standardError();
  const double more = 3 * kPilot * std::pow(pilotHalfWidth / wanted, 2);
  const auto samples = static_cast<uint32_t>(std::clamp(more, double{kPilot}, double{1u << 20}));
  const Moments mean = pixels({kPilot, kPilot + samples});
  expectHealthy(tracer.statistics());
  const double halfWidth = quantile * mean.standardError();
  EXPECT_LT(halfWidth, wanted) << "inconclusive: " << samples << " samples, mean " << mean.mean();
  EXPECT_NEAR(mean.mean(), analytic.radiance, halfWidth + 1e-4 * analytic.radiance) << samples << " samples";
}

double floorOf(const AnalyticScene& analytic, const Crossing& crossing, double usual) {
  if (analytic.lightsAloneDiverge && crossing.lights == Lights::LightsOnly) return 0.1;
  return usual;
}

class TechniqueCross : public testing::TestWithParam<Crossing> {};

TEST_P(TechniqueCross, AnalyticScenesKeepTheirRadiance) {
  const AnalyticScene analytic = sceneMakers()[GetParam().scene].make();
  expectRadiance(analytic, GetParam(), floorOf(analytic, GetParam(), 0.03));
}

INSTANTIATE_TEST_SUITE_P(Render, TechniqueCross, testing::ValuesIn(someCrossings()), crossingName);

class TechniqueCrossSlow : public testing::TestWithParam<Crossing> {};

TEST_P(TechniqueCrossSlow, AnalyticScenesKeepTheirRadiance) {
  const AnalyticScene analytic = sceneMakers()[GetParam().scene].make();
  expectRadiance(analytic, GetParam(), floorOf(analytic, GetParam(), kPowerFloor));
}

INSTANTIATE_TEST_SUITE_P(Render, TechniqueCrossSlow, testing::ValuesIn(allCrossings()), crossingName);

// A point has no size that a direction could find, so light-sampling=bsdf still samples it: the closed form, not black.
// What it leaves to directions is light of some size; of that, light-sampling=lights shows directly what the camera
// sees, and nothing twice.
TEST(TechniqueCrossModes, PointsAreLitHoweverLightsAreSampled) {
  const AnalyticScene point = sceneMakers()[4].make();
  ASSERT_STREQ(point.name, "Point");
  for (const auto lights : {Lights::MisPower, Lights::LightsOnly, Lights::BsdfOnly}) {
    const Crossing crossing{4, lights, SamplerKind::Sobol, LightSelection::Bvh};
    const Image image =
        renderImage(point.scene, point.camera, 4, 4, 4, {.estimator = crossing.settings(point.maxDepth)});
    for (const float value : plane(image, "G")) EXPECT_NEAR(value, point.radiance, 1e-5 * point.radiance);
  }
}

// Number 23 close to the light: h / R = 1e-3. Sampling by area alone hardly ever finds the part that matters, a
// millionth of the disk; the others see 0.999999.
TEST(TechniqueCrossModes, Test23ADiskAThousandTimesWiderThanItsDistance) {
  const AnalyticScene near = disk("NearDisk", 1000);
  for (const auto lights : {Lights::MisPower, Lights::BsdfOnly})
    expectRadiance(near, {2, lights, SamplerKind::Sobol, LightSelection::Bvh}, kPowerFloor);
}

// Number 27, the side that emits.
TEST(TechniqueCrossModes, Test27TheEmittingPlateInAMirrorTubeIsFiveThirds) {
  AnalyticScene tube = platesInMirrorTube();
  tube.camera = lookAt({0.4, 0.6, 1}, {0.5, 0.5, 0}, 0.3);
  tube.radiance = 5.0 / 3;
  expectRadiance(tube, {6, Lights::MisPower, SamplerKind::Sobol, LightSelection::Bvh}, kPowerFloor);
}

// Numbers 17, 30, 31 and 33 to the 0.3% that the list states; the default tests of the same numbers see 1% to 3%.
TEST(TechniqueCrossModesSlow, Test17Test30Test31Test33ToTheStatedFloor) {
  const Crossing usual;
  for (const auto& [degrees, expected] :
       {std::pair{0.0, 0.923077}, {45.0, 0.904327}, {60.0, 0.836232}, {80.0, 0.441229}})
    expectRadiance(panes(1, degrees, expected), usual, kPowerFloor);
  expectRadiance(panes(10, 0, 0.545455), usual, kPowerFloor);

  AnalyticScene series = furnace();
  series.maxDepth = 8;
  series.radiance = 1.99609375;
  expectRadiance(series, usual, kPowerFloor);

  Scene cube;
  cube.environment = constantEnvironment(glm::vec3(1));
  addPrimitive(cube, box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, false, addMaterial(cube, glass(0))));
  const Camera inside = lookAt({0.1, 0.05, -0.1}, {0.5, 0.07, -0.12}, 0.5);
  expectRadiance({"InsideGlass", std::move(cube), inside, 2.25}, usual, kPowerFloor);
}

} // namespace
} // namespace isophote
