// Which features a scene needs: keys the specialised kernels, goes into stats and headers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isophote/scene.hpp"

namespace isophote {

enum class Feature : uint32_t {
#define ISOPHOTE_FEATURE(id, constant, name, omitted) constant = id,
#include "shared/features.inc"
#undef ISOPHOTE_FEATURE
};

struct FeatureDescription {
  Feature feature;
  const char* name;
  const char* omitted; ///< what is not compiled, allocated or run without it
};

/// Every feature in the order of shared/features.inc.
[[nodiscard]] const std::vector<FeatureDescription>& allFeatures();

/// A set of features; bit n is the feature with id n.
class FeatureSet {
public:
  [[nodiscard]] static FeatureSet all();
  [[nodiscard]] bool has(Feature feature) const { return (bits_ >> static_cast<uint32_t>(feature)) & 1u; }
  void add(Feature feature) { bits_ |= 1u << static_cast<uint32_t>(feature); }
  void remove(Feature feature) { bits_ &= ~(1u << static_cast<uint32_t>(feature)); }
  [[nodiscard]] uint32_t bits() const { return bits_; }
  [[nodiscard]] std::vector<std::string> names() const;
  bool operator==(const FeatureSet&) const = default;

private:
  uint32_t bits_ = 0;
};

/// The features `scene` can need, the camera's excepted (PathTracer adds it).
[[nodiscard]] FeatureSet sceneFeatures(const Scene& scene);

} // namespace isophote
