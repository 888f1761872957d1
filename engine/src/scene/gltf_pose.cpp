// Source: Khronos glTF 2.0.1 specification, sections 3.7.2.2 "Morph Targets" and 3.7.3 "Skins".
#include "scene/gltf_pose.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace isophote::gltf {
namespace {

void addScaled(const std::vector<glm::vec3>& displacements, double weight, std::vector<glm::vec3>& values) {
  if (values.empty()) return;
  for (size_t i = 0; i < displacements.size(); ++i) {
    values[i] = glm::vec3(glm::dvec3(values[i]) + weight * glm::dvec3(displacements[i]));
  }
}

void addScaled(const std::vector<glm::vec3>& displacements, double weight, std::vector<glm::vec4>& values) {
  if (values.empty()) return;
  for (size_t i = 0; i < displacements.size(); ++i) {
    values[i] = glm::vec4(glm::vec3(glm::dvec3(values[i]) + weight * glm::dvec3(displacements[i])), values[i].w);
  }
}

/// Normals go by the cofactors: the inverse transpose but for scale and sign, defined for singular matrices too.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

void transformVertex(const glm::dmat4& matrix, size_t i, Primitive& vertices) {
  vertices.positions[i] = glm::vec3(glm::dvec3(matrix * glm::dvec4(vertices.positions[i], 1)));
  const glm::dmat3 linear(matrix);
  if (!vertices.normals.empty()) {
    const double side = glm::determinant(linear) < 0 ? -1 : 1;
    const glm::dvec3 normal = side * (cofactors(linear) * glm::dvec3(vertices.normals[i]));
    const double length = glm::length(normal);
    vertices.normals[i] = length > 0 ? glm::vec3(normal / length) : glm::vec3(0);
  }
  if (!vertices.tangents.empty()) {
    const glm::dvec3 tangent = linear * glm::dvec3(vertices.tangents[i]);
    const double length = glm::length(tangent);
    vertices.tangents[i] = glm::vec4(length > 0 ? glm::vec3(tangent / length) : glm::vec3(0), vertices.tangents[i].w);
  }
}

class Skinner {
public:
  Skinner(Document& document, const Pose& pose, const std::string& pointer, Attributes& attributes)
      : document_(document), pose_(pose), pointer_(pointer), attributes_(attributes) {}

  void run() {
    const size_t count = attributes_.vertices.positions.size();
    for (size_t i = 0; i < count; ++i) transformVertex(blend(i), i, attributes_.vertices);
    document_.warnings.add("vertices without joint weights stay with the first joint", pointer_, unweighted_);
  }

private:
  glm::dmat4 blend(size_t vertex) {
    glm::dmat4 sum(0);
    double total = 0;
    for (const JointSet& set : attributes_.jointSets) {
      for (int k = 0; k < 4; ++k) {
        const double weight = set.weights[vertex][k];
        if (!(weight > 0) || !std::isfinite(weight)) continue;
        sum += weight * jointMatrix(set.joints[vertex][k]);
        total += weight;
      }
    }
    if (total > 0) return sum / total;
    ++unweighted_;
    return jointMatrix(0);
  }

  const glm::dmat4& jointMatrix(uint32_t joint) const {
    if (joint >= pose_.objectFromBind.size()) {
      document_.fail(pointer_, fmt::format("joints below the {} of the skin, found {} "
                                           "(ACCESSOR_JOINTS_INDEX_OOB)",
                                           pose_.objectFromBind.size(), joint));
    }
    return pose_.objectFromBind[joint];
  }

  Document& document_;
  const Pose& pose_;
  const std::string& pointer_;
  Attributes& attributes_;
  uint64_t unweighted_ = 0;
};

} // namespace

void applyMorphTargets(const Document& document, const Accessors& accessors, const Json& primitive, const Pose& pose,
                       const std::string& pointer, Primitive& vertices) {
  const Json& targets = arrayOrEmpty(primitive, "targets");
  const size_t count = std::min(targets.size(), pose.morphWeights.size());
  for (size_t i = 0; i < count; ++i) {
    const double weight = pose.morphWeights[i];
    if (weight == 0) continue; // exact: most targets are simply off
    const MorphTarget target = readMorphTarget(document, accessors, targets[i], vertices.positions.size(),
                                               fmt::format("{}/targets/{}", pointer, i));
    addScaled(target.positions, weight, vertices.positions);
    addScaled(target.normals, weight, vertices.normals);
    addScaled(target.tangents, weight, vertices.tangents);
  }
}

void applySkin(Document& document, const Pose& pose, const std::string& pointer, Attributes& attributes) {
  if (pose.objectFromBind.empty()) return;
  if (attributes.jointSets.empty()) {
    document.warnings.add("a primitive without JOINTS_0 on a skinned node moves with the node", pointer);
    for (size_t i = 0; i < attributes.vertices.positions.size(); ++i) {
      transformVertex(pose.objectFromUnskinned, i, attributes.vertices);
    }
    return;
  }
  Skinner(document, pose, pointer, attributes).run();
}

} // namespace isophote::gltf
