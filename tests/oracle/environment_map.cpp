#include "oracle/environment_map.hpp"

#include <algorithm>
#include <cmath>

#include "oracle/ray.hpp"

namespace isophote::oracle {

EnvironmentMap::EnvironmentMap(const Environment& environment) : environment_(&environment) {
  cumulative_.push_back(0);
  for (uint32_t y = 0; y < environment.height; ++y) {
    for (uint32_t x = 0; x < environment.width; ++x) {
      double brightest = 0; // bilinear lookup inside this texel reads its neighbours too
      for (int64_t dy = -1; dy <= 1; ++dy) {
        for (int64_t dx = -1; dx <= 1; ++dx) {
          const glm::dvec3 value = texel(int64_t{x} + dx, int64_t{y} + dy);
          brightest = std::max({brightest, value.x, value.y, value.z});
        }
      }
      cumulative_.push_back(cumulative_.back() + brightest * texelSolidAngle(y));
    }
  }
  total_ = cumulative_.back();
}

glm::dvec3 EnvironmentMap::texel(int64_t x, int64_t y) const {
  const auto width = static_cast<int64_t>(environment_->width), height = static_cast<int64_t>(environment_->height);
  const int64_t column = ((x % width) + width) % width;
  const int64_t row = std::clamp<int64_t>(y, 0, height - 1);
  return glm::dvec3(environment_->pixels[static_cast<size_t>(row * width + column)]) *
         static_cast<double>(environment_->intensity);
}

double EnvironmentMap::texelSolidAngle(uint32_t y) const {
  const double height = environment_->height;
  return 2 * kPi / environment_->width * (std::cos(kPi * y / height) - std::cos(kPi * (y + 1) / height));
}

glm::dvec3 EnvironmentMap::mapFromWorld(glm::dvec3 d) const {
  const double c = std::cos(environment_->rotation), s = std::sin(environment_->rotation);
  return {c * d.x - s * d.z, d.y, s * d.x + c * d.z}; // rotation about +y by the negative angle
}

glm::dvec3 EnvironmentMap::radiance(glm::dvec3 d) const {
  const glm::dvec3 m = mapFromWorld(d);
  const double u = 0.5 + std::atan2(m.x, -m.z) / (2 * kPi);
  const double v = std::acos(std::clamp(m.y, -1.0, 1.0)) / kPi;
  const double x = u * environment_->width - 0.5, y = v * environment_->height - 0.5;
  const auto column = static_cast<int64_t>(std::floor(x)), row = static_cast<int64_t>(std::floor(y));
  const double fx = x - std::floor(x), fy = y - std::floor(y);
  return glm::mix(glm::mix(texel(column, row), texel(column + 1, row), fx),
                  glm::mix(texel(column, row + 1), texel(column + 1, row + 1), fx), fy);
}

glm::dvec3 EnvironmentMap::sample(double uTexel, glm::dvec2 uInside) const {
  const auto after = std::upper_bound(cumulative_.begin(), cumulative_.end(), uTexel * total_);
  const auto last = static_cast<std::ptrdiff_t>(cumulative_.size()) - 2;
  const std::ptrdiff_t index = std::clamp<std::ptrdiff_t>(after - cumulative_.begin() - 1, 0, last);
  const auto x = static_cast<double>(index % environment_->width), y = static_cast<double>(index / environment_->width);
  const double top = std::cos(kPi * y / environment_->height), bottom = std::cos(kPi * (y + 1) / environment_->height);
  const double cosTheta = std::clamp(top + (bottom - top) * uInside.y, -1.0, 1.0);
  const double sinTheta = std::sqrt(1 - cosTheta * cosTheta);
  const double phi = ((x + uInside.x) / environment_->width - 0.5) * 2 * kPi; // atan2(d.x, -d.z)
  const glm::dvec3 m(sinTheta * std::sin(phi), cosTheta, -sinTheta * std::cos(phi));
  const double c = std::cos(environment_->rotation), s = std::sin(environment_->rotation);
  return {c * m.x + s * m.z, m.y, -s * m.x + c * m.z};
}

double EnvironmentMap::pdf(glm::dvec3 d) const {
  if (!(total_ > 0)) return 0;
  const glm::dvec3 m = mapFromWorld(d);
  const double u = 0.5 + std::atan2(m.x, -m.z) / (2 * kPi);
  const double v = std::acos(std::clamp(m.y, -1.0, 1.0)) / kPi;
  const auto x = std::min(static_cast<uint32_t>(u * environment_->width), environment_->width - 1);
  const auto y = std::min(static_cast<uint32_t>(v * environment_->height), environment_->height - 1);
  const size_t index = static_cast<size_t>(y) * environment_->width + x;
  return (cumulative_[index + 1] - cumulative_[index]) / (total_ * texelSolidAngle(y));
}

} // namespace isophote::oracle
