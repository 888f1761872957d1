#include "oracle/reference_tracer.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "isophote/error.hpp"
#include "oracle/bodies.hpp"
#include "oracle/environment_map.hpp"
#include "oracle/light_list.hpp"
#include "oracle/medium.hpp"
#include "oracle/random_stream.hpp"
#include "oracle/reference_camera.hpp"
#include "oracle/scattering.hpp"
#include "oracle/sized_lights.hpp"
#include "oracle/surface.hpp"
#include "oracle/triangle_tree.hpp"

namespace isophote::oracle {

namespace {

/// Roulette starts after this many scattering events: short paths carry most of the light.
constexpr uint32_t kRouletteDepth = 3;

/// Distance, relative to the largest coordinate, below which hits are rounding: doubles carry 16 digits.
constexpr double kRelativeOffset = 1e-12;

/// Of paths that carry all colors: the nominal index of refraction.
constexpr int kNominal = -1;

class Tracer {
public:
  Tracer(const Scene& scene, const ReferenceSettings& settings)
      : scene_(scene), settings_(settings), tree_(flattenScene(scene)),
        environment_(scene.environment ? std::make_unique<EnvironmentMap>(*scene.environment) : nullptr),
        lights_(scene, tree_.triangles(), environment_.get()),
        hasBodies_(std::any_of(scene.materials.begin(), scene.materials.end(), Bodies::isBoundary)) {
    for (const Triangle& triangle : tree_.triangles()) {
      for (const glm::dvec3& vertex : {triangle.v0, triangle.v0 + triangle.edge1, triangle.v0 + triangle.edge2})
        offset_ = std::max({offset_, std::abs(vertex.x), std::abs(vertex.y), std::abs(vertex.z)});
    }
    offset_ *= kRelativeOffset;
  }

  /// One path: emission where it is hit, next-event estimation at every vertex, both weighted (Veach 1997, ch. 9 and
  /// 10). The camera lies outside of all bodies.
  [[nodiscard]] glm::dvec3 trace(const Ray& ray, RandomStream& random) const {
    Path path{ray, Bodies(scene_), ray.origin};
    path.last.delta = true; // emission seen from the camera has no other way to be found
    while (step(path, random)) {
    }
    return path.radiance;
  }

private:
  struct Path {
    Ray ray;
    Bodies bodies;      ///< around the ray
    glm::dvec3 vertex;  ///< where it scattered last: the ray may have passed boundaries since that do nothing
    ScatterSample last; ///< how it scattered there
    glm::dvec3 radiance{0}, beta{1};
    int channel = kNominal; ///< which color the path carries alone; kNominal: all
    double etaScale = 1;    ///< squared index of the path's medium over that at the camera: radiance / index^2 is kept
    uint32_t depth = 0;
  };

  /// What a face does to the bodies around a path, and the relative index there.
  struct Crossing {
    Bodies across;          ///< on the other side
    bool invisible = false; ///< light goes straight on, unchanged
    double ior = 1;         ///< of the body behind the face over that in front of it
  };

  /// Follows the path to where it next scatters or ends; false: it has ended.
  [[nodiscard]] bool step(Path& path, RandomStream& random) const {
    const Hit hit = tree_.closest(path.ray, [&](const Hit& candidate) { return covers(candidate, random); });
    const auto [sphere, distance] = closestSphere(path.ray, hit.t);
    if (const auto medium = path.bodies.medium(); medium && distance < kInfinity) {
      if (const auto t = travel(path, *medium, distance, random)) return scatterInMedium(path, *medium, *t, random);
    }
    if (sphere != kNoLight) {
      const glm::dvec3 Le = sphereRadiance(scene_.lights[sphere], path.vertex, path.ray.direction);
      path.radiance += path.beta * Le * hitWeight(path.last, lights_.pdfSized(sphere, path.vertex));
      return false;
    }
    if (hit.triangle != kNoTriangle) return meetSurface(path, hit, random);
    path.radiance += path.beta * escapedRadiance(path);
    return false;
  }

  /// Suns and environment, weighted.
  [[nodiscard]] glm::dvec3 escapedRadiance(const Path& path) const {
    glm::dvec3 radiance(0);
    for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
      const PunctualLight& sun = scene_.lights[i];
      if (!sun.isSun() || !sunCone(sun).contains(path.ray.direction)) continue;
      radiance += sunRadiance(sun) * hitWeight(path.last, lights_.pdfSized(i, path.vertex));
    }
    if (environment_ == nullptr) return radiance;
    const glm::dvec3 Le = environment_->radiance(path.ray.direction);
    return radiance + Le * hitWeight(path.last, lights_.pdfEnvironment(path.ray.direction));
  }

  /// Beer and Lambert where nothing scatters; else a free path by one color taken at random, all three weighted by the
  /// mean of their densities. @return distance of the scattering, if it comes before `limit`
  [[nodiscard]] static std::optional<double> travel(Path& path, const MediumCoefficients& medium, double limit,
                                                    RandomStream& random) {
    if (medium.extinction * medium.albedo == glm::dvec3(0)) {
      path.beta *= glm::exp(-medium.extinction * limit);
      return std::nullopt;
    }
    const double extinction = medium.extinction[std::min(static_cast<int>(3 * random.next()), 2)];
    const double t = -std::log1p(-random.next()) / extinction;
    const bool scatters = extinction > 0 && t < limit;
    glm::dvec3 density = glm::exp(-medium.extinction * (scatters ? t : limit));
    if (scatters) density *= medium.extinction;
    path.beta *= density / ((density.x + density.y + density.z) / 3);
    if (scatters) return t;
    return std::nullopt;
  }

  [[nodiscard]] bool scatterInMedium(Path& path, const MediumCoefficients& medium, double t,
                                     RandomStream& random) const {
    if (path.depth >= settings_.maxDepth) return false;
    const glm::dvec3 in = path.ray.direction;
    path.vertex = path.ray.origin + t * in;
    path.beta *= medium.albedo;
    const LightSample light = lights_.sample(path.vertex, random);
    const double phase = henyeyGreenstein(glm::dot(in, light.wi), medium.anisotropy);
    path.radiance +=
        path.beta * directLight(light, {glm::dvec3(phase), phase}, path.vertex, kNoTriangle, path.bodies, random);

    const double cosine = sampleHenyeyGreensteinCosine(medium.anisotropy, random.next());
    path.last = {};
    path.last.wi = aboutDirection(in, cosine, 2 * kPi * random.next());
    path.last.weight = glm::dvec3(1);
    path.last.pdf = henyeyGreenstein(cosine, medium.anisotropy);
    path.ray = {path.vertex, path.last.wi, 0, kInfinity, kNoTriangle, kNoTriangle};
    return survives(path, random);
  }

  /// The unit direction at an angle to `axis`, turned about it by `phi`.
  [[nodiscard]] static glm::dvec3 aboutDirection(glm::dvec3 axis, double cosine, double phi) {
    const glm::dvec3 aside = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(aside, axis));
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return glm::normalize(cosine * axis + sine * (std::cos(phi) * x + std::sin(phi) * glm::cross(axis, x)));
  }

  [[nodiscard]] bool meetSurface(Path& path, const Hit& hit, RandomStream& random) const {
    const glm::dvec3 wo = -path.ray.direction;
    const Triangle& triangle = tree_.triangles()[hit.triangle];
    SurfacePoint point = evaluateSurface(scene_, triangle, hit, wo);
    const Crossing before = crossing(path.bodies, triangle.material, point.frontFace, path.channel);
    if (before.invisible) {
      path.bodies = before.across;
      path.ray = {point.position, path.ray.direction, offset_, kInfinity, hit.triangle, kNoTriangle};
      return true;
    }
    if (point.unlit) {
      path.radiance += path.beta * point.emission;
      return false;
    }
    if (point.emission != glm::dvec3(0)) {
      const double distance = glm::distance(point.position, path.vertex);
      path.radiance +=
          path.beta * point.emission * hitWeight(path.last, lights_.pdfTriangle(hit.triangle, distance, -wo));
    }
    if (path.depth >= settings_.maxDepth) return false;

    disperse(point.material, path.channel, path.beta, random);
    const Crossing here = crossing(path.bodies, triangle.material, point.frontFace, path.channel);
    if (point.material.ior >= 1) point.material.ior = here.ior;
    const Scattering scattering(point, wo);
    path.vertex = point.position;
    const LightSample light = lights_.sample(point.position, random);
    const Bodies& lit = glm::dot(point.ng, light.wi) < 0 ? here.across : path.bodies;
    path.radiance += path.beta * directLight(light, light.pdf > 0 ? scattering.evaluate(light.wi) : ScatterValue{},
                                             point.position, hit.triangle, lit, random);
    path.last = scattering.sample(random);
    path.beta *= path.last.weight;
    path.etaScale *= path.last.eta * path.last.eta;
    if (glm::dot(point.ng, path.last.wi) < 0) path.bodies = here.across;
    path.ray = {point.position, path.last.wi, offset_, kInfinity, hit.triangle, kNoTriangle};
    return survives(path, random);
  }

  /// Russian roulette after a scattering.
  [[nodiscard]] bool survives(Path& path, RandomStream& random) const {
    const uint32_t depth = path.depth++;
    if (path.beta == glm::dvec3(0)) return false;
    if (settings_.maxDepth != kUnlimitedDepth || depth < kRouletteDepth) return true;
    const double survival = std::min(std::max({path.beta.x, path.beta.y, path.beta.z}) * path.etaScale, 1.0);
    if (random.next() >= survival) return false;
    path.beta /= survival;
    return true;
  }

  [[nodiscard]] Crossing crossing(const Bodies& here, uint32_t index, bool frontFace, int channel) const {
    const Material& material = scene_.materials[index];
    const double own = channelIor(double(material.ior), double(material.dispersion), channel);
    if (!Bodies::isBoundary(material)) return {here, false, own / here.ior(channel)};
    const Bodies across = here.across(index, frontFace);
    const double front = frontFace ? here.ior(channel) : across.ior(channel);
    const double behind = frontFace ? across.ior(channel) : here.ior(channel);
    const bool refracts = material.transmission.factor > 0;
    const bool clear = material.transmission.factor == 1 && !material.transmission.texture.present() &&
                       material.metallic == 0 && material.baseColor == glm::vec4(1);
    return {across, here.filling() == across.filling() || (clear && front == behind),
            (refracts ? behind : own) / front};
  }

  /// Gives dispersive glass the channel of the path, which the first one met chooses.
  static void disperse(const SurfaceMaterial& material, int& channel, glm::dvec3& beta, RandomStream& random) {
    if (material.dispersion == 0 || material.thinWalled || material.transmission == 0 || material.ior <= 1) return;
    if (channel >= 0) return;
    channel = std::min(static_cast<int>(3 * random.next()), 2);
    for (int c = 0; c < 3; ++c) beta[c] *= c == channel ? 3 : 0;
  }

  [[nodiscard]] bool covers(const Hit& hit, RandomStream& random) const {
    const Triangle& triangle = tree_.triangles()[hit.triangle];
    if (triangle.opaque) return true;
    const double coverage = evaluateCoverage(scene_, triangle, hit);
    return coverage >= 1 || random.next() < coverage;
  }

  /// The sphere light that the ray meets first, before `limit`, and how far the ray gets.
  [[nodiscard]] std::pair<uint32_t, double> closestSphere(Ray ray, double limit) const {
    uint32_t closest = kNoLight;
    ray.tMax = std::min(ray.tMax, limit);
    for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
      if (!scene_.lights[i].isSphere()) continue;
      const double t = intersectSphere(scene_.lights[i], ray);
      if (t == kInfinity) continue;
      closest = i;
      ray.tMax = t;
    }
    return {closest, ray.tMax};
  }

  /// Whether a sphere light other than `target` is in the way.
  [[nodiscard]] bool behindSphere(const Ray& shadow, uint32_t target) const {
    for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
      if (i != target && scene_.lights[i].isSphere() && intersectSphere(scene_.lights[i], shadow) != kInfinity)
        return true;
    }
    return false;
  }

  /// Balance-heuristic weight of meeting a light by the direction `last` whose light sample has density `lightPdf`.
  [[nodiscard]] double hitWeight(const ScatterSample& last, double lightPdf) const {
    if (last.delta || settings_.lightSampling == LightSampling::BsdfOnly || !(lightPdf > 0)) return 1;
    if (settings_.lightSampling == LightSampling::LightsOnly) return 0;
    return last.pdf / (last.pdf + lightPdf);
  }

  /// What a light sample adds at a vertex that scatters it by `scattered`.
  /// @param leaving triangle of the vertex, kNoTriangle inside a medium
  /// @param bodies  around the shadow ray
  [[nodiscard]] glm::dvec3 directLight(const LightSample& light, const ScatterValue& scattered, glm::dvec3 position,
                                       uint32_t leaving, const Bodies& bodies, RandomStream& random) const {
    if (!(light.pdf > 0) || light.radiance == glm::dvec3(0) || scattered.value == glm::dvec3(0)) return glm::dvec3(0);
    if (leaving != kNoTriangle && light.triangle == leaving) return glm::dvec3(0);
    if (!light.punctual && settings_.lightSampling == LightSampling::BsdfOnly) return glm::dvec3(0);
    const Ray shadow{position, light.wi, offset_, light.distance - offset_, leaving, light.triangle};
    if (behindSphere(shadow, light.sphere)) return glm::dvec3(0);
    const bool alone = light.punctual || settings_.lightSampling == LightSampling::LightsOnly;
    const double weight = alone ? 1 : light.pdf / (light.pdf + scattered.pdf);
    return scattered.value * light.radiance * (weight / light.pdf) * visibility(shadow, bodies, random);
  }

  /// What reaches the start of a shadow ray: boundaries that do nothing are passed, everything else blocks.
  [[nodiscard]] glm::dvec3 visibility(Ray shadow, Bodies bodies, RandomStream& random) const {
    const auto accept = [&](const Hit& candidate) { return covers(candidate, random); };
    if (!hasBodies_) return glm::dvec3(tree_.occluded(shadow, accept) ? 0 : 1);
    glm::dvec3 passed(1);
    while (true) {
      const Hit hit = tree_.closest(shadow, accept);
      const double end = std::min(hit.t, shadow.tMax);
      if (const auto medium = bodies.medium(); medium && end < kInfinity) passed *= glm::exp(-medium->extinction * end);
      if (hit.triangle == kNoTriangle) return passed;
      const Triangle& triangle = tree_.triangles()[hit.triangle];
      const bool frontFace = glm::dot(triangle.ng, shadow.direction) < 0;
      const Crossing met = crossing(bodies, triangle.material, frontFace, kNominal);
      if (!met.invisible) return glm::dvec3(0);
      bodies = met.across;
      shadow.origin += hit.t * shadow.direction;
      shadow.tMax -= hit.t;
      shadow.leaving = hit.triangle;
    }
  }

  const Scene& scene_;
  ReferenceSettings settings_;
  TriangleTree tree_;
  std::unique_ptr<EnvironmentMap> environment_;
  LightList lights_;
  bool hasBodies_;
  double offset_ = 0; ///< world units
};

/// Uniform on the aperture of radius 1, by rejection: inside every blade, the first corner at the rotation's angle.
glm::dvec2 sampleLens(const Camera& camera, RandomStream& random) {
  const uint32_t blades = camera.apertureBlades;
  while (true) {
    const glm::dvec2 p = 2.0 * random.next2() - 1.0;
    bool inside = glm::dot(p, p) <= 1;
    for (uint32_t i = 0; blades >= 3 && i < blades; ++i) {
      const double middle =
          camera.apertureRotation + kPi * (2 * i + 1) / blades; // of the edge between corners i, i + 1
      inside = inside && glm::dot(p, {std::cos(middle), std::sin(middle)}) <= std::cos(kPi / blades);
    }
    if (inside) return p;
  }
}

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
          const glm::dvec2 lens = camera.hasLens() ? sampleLens(camera, random) : glm::dvec2(0);
          estimate.add(tracer.trace(cameraRay(camera, width, height, pixel, lens), random));
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
