#include "glsl/traversal_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/gtc/matrix_transform.hpp>

namespace isophote::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Barycentric weights and distance of a ray against a triangle (Moeller and Trumbore 1997), in double; no tests.
struct Crossing {
  double t = 0;
  glm::dvec3 weights{-1}; // of v0, v1, v2
};

Crossing cross(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3 (&v)[3]) {
  const glm::dvec3 e1 = v[1] - v[0], e2 = v[2] - v[0];
  const glm::dvec3 p = glm::cross(direction, e2);
  const double determinant = glm::dot(e1, p);
  if (determinant == 0) return {};
  const glm::dvec3 s = origin - v[0];
  const glm::dvec3 q = glm::cross(s, e1);
  const double b1 = glm::dot(s, p) / determinant;
  const double b2 = glm::dot(direction, q) / determinant;
  return {glm::dot(e2, q) / determinant, {1 - b1 - b2, b1, b2}};
}

} // namespace

std::vector<gpu::SpecConstant> featureConstants(const FeatureSet& features) {
  std::vector<gpu::SpecConstant> constants;
  for (const FeatureDescription& description : allFeatures())
    constants.push_back({static_cast<uint32_t>(description.feature), features.has(description.feature) ? 1u : 0u});
  return constants;
}

Mesh meshOf(std::vector<glm::vec3> positions, std::vector<uint32_t> indices, uint32_t material) {
  Primitive primitive;
  if (indices.empty()) {
    indices.resize(positions.size());
    std::iota(indices.begin(), indices.end(), 0u);
  }
  primitive.positions = std::move(positions);
  primitive.indices = std::move(indices);
  primitive.material = material;
  Mesh mesh;
  mesh.primitives.push_back(std::move(primitive));
  return mesh;
}

Scene sceneOf(std::vector<Mesh> meshes) {
  Scene scene;
  Material material;
  material.metallic = 0;
  material.specular = 0;
  scene.materials.push_back(material);
  scene.meshes = std::move(meshes);
  for (uint32_t i = 0; i < scene.meshes.size(); ++i) {
    Instance instance;
    instance.mesh = i;
    scene.instances.push_back(instance);
  }
  return scene;
}

Mesh sphereMesh(glm::vec3 center, float radius, uint32_t rings) {
  std::vector<glm::vec3> positions;
  const uint32_t columns = 2 * rings;
  for (uint32_t r = 0; r <= rings; ++r) {
    for (uint32_t c = 0; c < columns; ++c) {
      const double theta = kPi * r / rings;
      const double phi = 2 * kPi * c / columns;
      const bool pole = r == 0 || r == rings; // one point, whatever phi
      const double s = pole ? 0 : std::sin(theta);
      positions.push_back(center + radius * glm::vec3(s * std::cos(phi), std::cos(theta), s * std::sin(phi)));
    }
  }
  std::vector<uint32_t> indices;
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    const glm::vec3 &pa = positions[a], &pb = positions[b], &pc = positions[c];
    if (pa != pb && pb != pc && pc != pa) indices.insert(indices.end(), {a, b, c});
  };
  for (uint32_t r = 0; r < rings; ++r) {
    for (uint32_t c = 0; c < columns; ++c) {
      const uint32_t a = r * columns + c, b = r * columns + (c + 1) % columns;
      add(a, b, a + columns);
      add(b, b + columns, a + columns);
    }
  }
  return meshOf(std::move(positions), std::move(indices));
}

/// Three draws in a row, z first: in the arguments of a call each compiler has an order of its own.
template <class Next> static glm::dvec3 drawVector(const Next& next) {
  const double z = next(), y = next(), x = next();
  return {x, y, z};
}

std::vector<glm::vec3> triangleSoup(uint32_t count, float size, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto point = [&] { return glm::vec3(drawVector([&] { return unit(random); })); };
  std::vector<glm::vec3> positions;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 first = point();
    positions.push_back(first);
    positions.push_back(first + size * point());
    positions.push_back(first + size * point());
  }
  return positions;
}

glm::vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::vec3(glm::normalize(drawVector([&] { return normal(random); })));
}

glm::dmat4 randomPlacement(std::mt19937& random, double spread) {
  std::uniform_real_distribution<double> unit(-1, 1);
  glm::dmat4 placement = glm::translate(glm::dmat4(1), spread * drawVector([&] { return unit(random); }));
  const glm::dvec3 axis(randomDirection(random));
  placement = glm::rotate(placement, kPi * unit(random), axis);
  const double mirror = unit(random) < 0 ? -1 : 1;
  return glm::scale(placement, glm::dvec3(mirror, 1, 1) * drawVector([&] { return std::exp2(2 * unit(random)); }));
}

std::optional<ReferenceHit> bruteForceHit(const Scene& scene, const glm::dvec3& origin, const glm::dvec3& direction,
                                          double tMax) {
  ReferenceHit best;
  best.t = std::numeric_limits<double>::infinity();
  double nearestMiss = std::numeric_limits<double>::infinity(); // how far outside the nearest of the triangles missed
  double second = std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Primitive& primitive = scene.meshes[instance.mesh].primitives[0];
    const glm::dmat4 inverse = glm::inverse(instance.worldFromObject);
    const glm::dvec3 o(inverse * glm::dvec4(origin, 1)), d(inverse * glm::dvec4(direction, 0));
    for (uint32_t k = 0; k < primitive.indices.size() / 3; ++k) {
      const glm::dvec3 v[3] = {primitive.positions[primitive.indices[3 * k]],
                               primitive.positions[primitive.indices[3 * k + 1]],
                               primitive.positions[primitive.indices[3 * k + 2]]};
      const Crossing crossing = cross(o, d, v);
      if (!(crossing.t > 0) || crossing.t >= tMax) continue;
      const double inside = std::min({crossing.weights.x, crossing.weights.y, crossing.weights.z});
      if (inside < 0) {
        nearestMiss = std::min(nearestMiss, -inside);
      } else if (crossing.t < best.t) {
        second = best.t;
        best = {crossing.t, i, k, {crossing.weights.y, crossing.weights.z}, inside};
      } else {
        second = std::min(second, crossing.t);
      }
    }
  }
  best.margin = std::min({best.margin, nearestMiss, (second - best.t) / best.t});
  if (best.t == std::numeric_limits<double>::infinity()) {
    if (nearestMiss > 1e-4) return std::nullopt;
    best.margin = 0;
  }
  return best;
}

} // namespace isophote::test
