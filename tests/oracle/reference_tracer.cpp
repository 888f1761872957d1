#include "oracle/reference_tracer.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <thread>

#include "isophote/error.hpp"
#include "oracle/environment_map.hpp"
#include "oracle/light_list.hpp"
#include "oracle/random_stream.hpp"
#include "oracle/reference_camera.hpp"
#include "oracle/scattering.hpp"
#include "oracle/surface.hpp"
#include "oracle/triangle_tree.hpp"

namespace isophote::oracle {

namespace {

/// Roulette starts after this many scattering events: short paths carry most of the light.
constexpr uint32_t kRouletteDepth = 3;

/// Distance, relative to the largest coordinate, below which hits are rounding: doubles carry 16 digits.
constexpr double kRelativeOffset = 1e-12;

class Tracer {
public:
  Tracer(const Scene& scene, const ReferenceSettings& settings)
      : scene_(scene), settings_(settings), tree_(flattenScene(scene)),
        environment_(scene.environment ? std::make_unique<EnvironmentMap>(*scene.environment) : nullptr),
        lights_(scene, tree_.triangles(), environment_.get()) {
    for (const Triangle& triangle : tree_.triangles()) {
      for (const glm::dvec3& vertex : {triangle.v0, triangle.v0 + triangle.edge1, triangle.v0 + triangle.edge2})
        offset_ = std::max({offset_, std::abs(vertex.x), std::abs(vertex.y), std::abs(vertex.z)});
    }
    offset_ *= kRelativeOffset;
  }

  /// One path: emission where it is hit, next-event estimation at every vertex, both weighted (Veach 1997, ch. 9 and
  /// 10).
  [[nodiscard]] glm::dvec3 trace(Ray ray, RandomStream& random) const {
    glm::dvec3 radiance(0), beta(1);
    double etaScale = 1; // squared index of the path's medium over that at the camera: radiance / index^2 is kept
    ScatterSample last;
    last.delta = true; // emission seen from the camera has no other way to be found
    for (uint32_t depth = 0;; ++depth) {
      const glm::dvec3 wo = -ray.direction;
      const Hit hit = tree_.closest(ray, [&](const Hit& candidate) { return covers(candidate, random); });
      if (hit.triangle == kNoTriangle) {
        if (environment_ != nullptr)
          radiance += beta * environment_->radiance(-wo) * hitWeight(last, lights_.pdfEnvironment(-wo));
        return radiance;
      }
      const SurfacePoint point = evaluateSurface(scene_, tree_.triangles()[hit.triangle], hit, wo);
      if (point.unlit) return radiance + beta * point.emission;
      if (point.emission != glm::dvec3(0))
        radiance += beta * point.emission * hitWeight(last, lights_.pdfTriangle(hit.triangle, hit.t, -wo));
      if (depth >= settings_.maxDepth) return radiance;

      const Scattering scattering(point, wo);
      radiance += beta * directLight(point, hit.triangle, scattering, random);
      last = scattering.sample(random);
      beta *= last.weight;
      etaScale *= last.eta * last.eta;
      if (beta == glm::dvec3(0)) return radiance;
      if (settings_.maxDepth == kUnlimitedDepth && depth >= kRouletteDepth) {
        const double survival = std::min(std::max({beta.x, beta.y, beta.z}) * etaScale, 1.0);
        if (random.next() >= survival) return radiance;
        beta /= survival;
      }
      ray = {point.position, last.wi, offset_, kInfinity, hit.triangle, kNoTriangle};
    }
  }

private:
  [[nodiscard]] bool covers(const Hit& hit, RandomStream& random) const {
    const Triangle& triangle = tree_.triangles()[hit.triangle];
    if (triangle.opaque) return true;
    const double coverage = evaluateCoverage(scene_, triangle, hit);
    return coverage >= 1 || random.next() < coverage;
  }

  /// Balance-heuristic weight of meeting a light by the direction `last` whose light sample has density `lightPdf`.
  [[nodiscard]] double hitWeight(const ScatterSample& last, double lightPdf) const {
    if (last.delta || settings_.lightSampling == LightSampling::BsdfOnly || !(lightPdf > 0)) return 1;
    if (settings_.lightSampling == LightSampling::LightsOnly) return 0;
    return last.pdf / (last.pdf + lightPdf);
  }

  [[nodiscard]] glm::dvec3 directLight(const SurfacePoint& point, uint32_t leaving, const Scattering& scattering,
                                       RandomStream& random) const {
    const LightSample light = lights_.sample(point.position, random);
    if (!(light.pdf > 0) || light.triangle == leaving || light.radiance == glm::dvec3(0)) return glm::dvec3(0);
    if (!light.punctual && settings_.lightSampling == LightSampling::BsdfOnly) return glm::dvec3(0);
    const ScatterValue scattered = scattering.evaluate(light.wi);
    if (scattered.value == glm::dvec3(0)) return glm::dvec3(0);
    const Ray shadow{point.position, light.wi, offset_, light.distance - offset_, leaving, light.triangle};
    if (tree_.occluded(shadow, [&](const Hit& candidate) { return covers(candidate, random); })) return glm::dvec3(0);
    const bool alone = light.punctual || settings_.lightSampling == LightSampling::LightsOnly;
    const double weight = alone ? 1 : light.pdf / (light.pdf + scattered.pdf);
    return scattered.value * light.radiance * (weight / light.pdf);
  }

  const Scene& scene_;
  ReferenceSettings settings_;
  TriangleTree tree_;
  std::unique_ptr<EnvironmentMap> environment_;
  LightList lights_;
  double offset_ = 0; ///< world units
};

/// Running mean and sum of squared deviations (Welford 1962).
struct Welford {
  uint32_t count = 0;
  glm::dvec3 mean{0};
  glm::dvec3 squares{0};

  void add(glm::dvec3 value) {
    const glm::dvec3 before = value - mean;
    mean += before / static_cast<double>(++count);
    squares += before * (value - mean);
  }
  [[nodiscard]] glm::dvec3 standardError() const {
    return glm::sqrt(squares / (static_cast<double>(count) * (count - 1.0)));
  }
};

} // namespace

ReferenceImage renderReference(const Scene& scene, const Camera& camera, uint32_t width, uint32_t height,
                               uint32_t samplesPerPixel, const ReferenceSettings& settings) {
  if (width == 0 || height == 0 || samplesPerPixel < 2)
    throw UsageError("reference: empty image or fewer than 2 samples");
  const Tracer tracer(scene, settings);
  ReferenceImage image{width, height, samplesPerPixel, std::vector<ReferencePixel>(size_t{width} * height)};
  std::atomic<uint32_t> nextRow{0};
  const auto work = [&] {
    for (uint32_t y = nextRow++; y < height; y = nextRow++) {
      for (uint32_t x = 0; x < width; ++x) {
        RandomStream random(settings.seed, x, y);
        Welford estimate;
        for (uint32_t sample = 0; sample < samplesPerPixel; ++sample) {
          const glm::dvec2 pixel = glm::dvec2(x, y) + random.next2();
          estimate.add(tracer.trace(cameraRay(camera, width, height, pixel), random));
        }
        image.pixels[size_t{y} * width + x] = {estimate.mean, estimate.standardError()};
      }
    }
  };
  const uint32_t count = settings.threads != 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> threads;
  for (uint32_t i = 1; i < count; ++i) threads.emplace_back(work);
  work();
  threads.clear(); // joins
  return image;
}

} // namespace isophote::oracle
