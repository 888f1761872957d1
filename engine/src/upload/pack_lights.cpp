#include "upload/pack_lights.hpp"

#include "accel/light_tree.hpp"
#include "isophote/error.hpp"
#include "upload/alias_table.hpp"
#include "upload/environment_density.hpp"
#include "upload/pack_emission.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace isophote {
namespace {

// Sine of a triangle's angle below which the device's normal may be far from the exact one.
constexpr double kSmallestSine = 1e-4;
constexpr double kPi = 3.14159265358979323846;

// Point lights count with their irradiance at the scene's radius over this. At a thousandth of that distance, where
// they are a million times as bright, a pixel still holds 256 samples; at a thousand times of it, 2^-20 as bright, a
// sample's rounding is 2.5e-6 of it.
constexpr double kNearLamp = 128;

double largestComponent(const glm::dvec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

// Collects the lights' bounds (luminance) in the order of light indices and the largest radiance that one event can
// add.
class LightPacker {
public:
  LightPacker(const Scene& scene, const PackedGeometry& geometry, PackedScene& packed)
      : scene_(scene), geometry_(geometry), packed_(packed), emission_(scene) {}

  void pack() {
    addEmissiveTriangles();
    addPunctualLights();
    if (scene_.environment) addEnvironment(*scene_.environment);
    addUnlit();
    packed_.lightAlias = buildAliasTable(powers());
    if (packed_.features.has(Feature::kHasLightTree)) buildTree();
    const double brightest = std::max(largest_, received_);
    packed_.emitterScale = brightest > 0 ? powerOfTwoAbove(brightest) : 1.0f;
  }

private:
  [[nodiscard]] std::vector<double> powers() const {
    std::vector<double> result;
    for (const LightBound& light : lights_) result.push_back(light.power);
    return result;
  }

  void buildTree() {
    if (lights_.size() > gpu::kLightTreeMaxLights)
      throw LimitError("the scene has " + std::to_string(lights_.size()) + " lights; their tree holds " +
                       std::to_string(gpu::kLightTreeMaxLights));
    LightTree tree = buildLightTree(lights_);
    packed_.lightTree = std::move(tree.nodes);
    packed_.lightTrails = std::move(tree.trails);
    packed_.lightTreeScale = tree.scale;
  }

  // Clamped so that neither it nor its inverse leaves the range of float.
  static float powerOfTwoAbove(double value) {
    return static_cast<float>(std::exp2(std::clamp(std::ceil(std::log2(value)), -100.0, 100.0)));
  }

  void addEmissiveTriangles() {
    const std::vector<std::vector<double>> luminances = meshLuminances();
    uint64_t total = 0;
    for (const gpu::InstanceRecord& instance : packed_.instances) {
      if (instance.flags != gpu::kInstanceSphere) total += geometry_.meshes[instance.mesh].emitters.size();
    }
    if (total + scene_.lights.size() + 1 >= gpu::kInvalidIndex)
      throw LimitError("the scene has " + std::to_string(total) +
                       " emissive triangles, instances counted; light indices have 32 bits");
    packed_.emissiveTriangles.reserve(total);
    lights_.reserve(total + scene_.lights.size() + 1);
    for (uint32_t i = 0; i < packed_.instances.size(); ++i) {
      gpu::InstanceRecord& instance = packed_.instances[i];
      if (instance.flags == gpu::kInstanceSphere) continue;
      const PackedMesh& mesh = geometry_.meshes[instance.mesh];
      if (mesh.emitters.empty()) continue;
      instance.firstEmitter = static_cast<uint32_t>(packed_.emissiveTriangles.size());
      const glm::dmat4& worldFromObject(scene_.instances[geometry_.sceneInstances[i]].worldFromObject);
      for (size_t k = 0; k < mesh.emitters.size(); ++k) {
        const MeshEmitter& emitter = mesh.emitters[k];
        packed_.emissiveTriangles.push_back({i, emitter.triangle});
        lights_.push_back(emitterBound(worldFromObject, emitter, luminances[instance.mesh][k]));
      }
    }
  }

  // Mean luminance of what each emitter of each mesh sends out.
  std::vector<std::vector<double>> meshLuminances() {
    std::vector<std::vector<double>> result(geometry_.meshes.size());
    for (size_t i = 0; i < result.size(); ++i) {
      for (const MeshEmitter& emitter : geometry_.meshes[i].emitters) {
        const Primitive& primitive = scene_.meshes[emitter.mesh].primitives[emitter.primitive];
        const Material& material = scene_.materials[primitive.material];
        result[i].push_back(emission_.meanLuminance(material, primitive, emitter.primitiveIndex));
        largest_ = std::max(largest_, largestComponent(emission_.largestRadiance(material)));
      }
    }
    return result;
  }

  [[nodiscard]] LightBound emitterBound(const glm::dmat4& worldFromObject, const MeshEmitter& emitter,
                                        double radiance) const {
    const gpu::BvhTriangle& t = packed_.triangles[emitter.triangle];
    const auto place = [&](const glm::vec3& v) {
      return glm::dvec3(worldFromObject * glm::dvec4(glm::dvec3(v), 1)) - packed_.worldOrigin;
    };
    const glm::dvec3 v0 = place(t.v0);
    const glm::dvec3 v1 = place(t.v1);
    const glm::dvec3 v2 = place(t.v2);
    const glm::dvec3 normal = glm::cross(v1 - v0, v2 - v0);
    const double twiceArea = glm::length(normal);
    LightBound bound;
    bound.lower = glm::min(v0, glm::min(v1, v2));
    bound.upper = glm::max(v0, glm::max(v1, v2));
    // A mirroring map takes the front along.
    const double side = glm::determinant(glm::dmat3(worldFromObject)) < 0 ? -1 : 1;
    if (twiceArea > 0) bound.axis = side / twiceArea * normal;
    bound.thetaE = kPi / 2;
    // What is almost a line has a normal of chance.
    if (!(twiceArea > kSmallestSine * glm::length(v1 - v0) * glm::length(v2 - v0))) bound.thetaO = kPi;
    const gpu::Geometry& geometry = packed_.geometries[t.geometry];
    bound.twoSided = (packed_.materials[geometry.material].flags & gpu::kMaterialDoubleSided) != 0;
    bound.intensity = 0.5 * twiceArea * radiance;
    bound.power = (bound.twoSided ? 2 : 1) * kPi * bound.intensity;
    return bound;
  }

  void addPunctualLights() {
    std::vector<uint32_t> instanceOf(scene_.lights.size(), gpu::kInvalidIndex);
    for (uint32_t i = 0; i < packed_.instances.size(); ++i) {
      if (packed_.instances[i].flags == gpu::kInstanceSphere) instanceOf[geometry_.sceneInstances[i]] = i;
    }
    for (const bool suns : {true, false}) {
      for (size_t i = 0; i < scene_.lights.size(); ++i) {
        if (scene_.lights[i].isSun() == suns) addPunctual(scene_.lights[i], instanceOf[i]);
      }
    }
  }

  void addPunctual(const PunctualLight& light, uint32_t instance) {
    gpu::PunctualLightRecord record{};
    record.position = glm::vec3(light.position - packed_.worldOrigin);
    record.kind = static_cast<uint32_t>(light.kind);
    record.direction = glm::vec3(light.direction);
    record.range = light.range;
    record.intensity = light.intensity;
    record.cosInner = static_cast<float>(std::cos(static_cast<double>(light.innerConeAngle)));
    record.cosOuter = static_cast<float>(std::cos(static_cast<double>(light.outerConeAngle)));
    record.instance = instance;
    if (light.radius > 0) setSize(light, record);
    if (light.isSun()) ++packed_.sunCount;
    if (light.isSphere())
      packed_.instances[instance].firstEmitter =
          static_cast<uint32_t>(packed_.emissiveTriangles.size() + packed_.punctualLights.size());
    packed_.punctualLights.push_back(record);

    const double squaredRadius = packed_.worldRadius * packed_.worldRadius;
    const double intensity = luminance(light.intensity);
    LightBound bound;
    const glm::dvec3 reach(light.isSphere() ? double{light.radius} : 0.0);
    bound.lower = light.position - packed_.worldOrigin - reach;
    bound.upper = light.position - packed_.worldOrigin + reach;
    bound.intensity = intensity;
    switch (light.kind) {
    case LightKind::Point:
      bound.thetaO = kPi;
      bound.thetaE = kPi / 2;
      bound.power = 4 * kPi * intensity;
      break;
    case LightKind::Spot:
      bound.axis = light.direction;
      bound.thetaO = static_cast<double>(light.innerConeAngle);
      bound.thetaE = static_cast<double>(light.outerConeAngle) - bound.thetaO;
      // The falloff's square root is linear in the cosine: its integral between the cones is a third.
      bound.power =
          2 * kPi * intensity * ((1 - record.cosInner) + std::max(0.0f, record.cosInner - record.cosOuter) / 3.0);
      break;
    case LightKind::Directional:
      bound.infinite = true;
      bound.power = kPi * squaredRadius * intensity;
      break;
    }
    lights_.push_back(bound);
    // Reflected radiance is about the irradiance of all lights together: one sample of a light stands for all.
    const double strength = largestComponent(light.intensity);
    received_ += light.kind == LightKind::Directional ? strength : strength * kNearLamp * kNearLamp / squaredRadius;
  }

  // Radiance of a light with a size: the intensity over the sphere's cross section, or the irradiance over the disk's
  // projected solid angle, pi sin^2.
  void setSize(const PunctualLight& light, gpu::PunctualLightRecord& record) {
    const double radius = light.radius;
    const double half = std::sin(0.5 * radius);
    const double extent = light.isSun() ? std::sin(radius) : radius;
    const glm::dvec3 radiance = glm::dvec3(light.intensity) / (kPi * extent * extent);
    record.size = static_cast<float>(light.isSun() ? 2 * half * half : radius);
    record.intensity = glm::vec3(radiance);
    largest_ = std::max(largest_, largestComponent(radiance));
  }

  void addEnvironment(const Environment& environment) {
    EnvironmentDensity density = environmentDensity(environment);
    const double power = kPi * packed_.worldRadius * packed_.worldRadius * density.power * environment.intensity;
    if (!(power > 0)) return;
    packed_.environmentWidth = environment.width;
    packed_.environmentHeight = environment.height;
    packed_.environmentCosRotation = static_cast<float>(std::cos(environment.rotation));
    packed_.environmentSinRotation = static_cast<float>(std::sin(environment.rotation));
    packed_.environmentMarginal = std::move(density.marginal);
    packed_.environmentConditional = std::move(density.conditional);
    packed_.environmentPixels = environment.pixels;
    for (glm::vec3& pixel : packed_.environmentPixels) {
      pixel *= environment.intensity;
      largest_ = std::max(largest_, largestComponent(pixel));
    }
    LightBound bound;
    bound.infinite = true;
    bound.power = power;
    lights_.push_back(bound);
  }

  // Unlit surfaces are no lights, but the camera sees them shine.
  void addUnlit() {
    for (const gpu::MaterialRecord& material : packed_.materials) {
      if (material.flags & gpu::kMaterialUnlit)
        largest_ = std::max(largest_, largestComponent(glm::dvec3(material.baseColor)));
    }
  }

  const Scene& scene_;
  const PackedGeometry& geometry_;
  PackedScene& packed_;
  EmissionEstimator emission_;
  std::vector<LightBound> lights_; // in the order of light indices
  double largest_ = 0;             // radiance that the camera can see
  double received_ = 0;            // irradiance by lights without a surface of their own
};

} // namespace

void packLights(const Scene& scene, const PackedGeometry& geometry, PackedScene& packed) {
  LightPacker(scene, geometry, packed).pack();
}

} // namespace isophote
