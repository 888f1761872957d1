// The reference tracer's random numbers: nothing in common with the engine's.
#pragma once

#include <cstdint>
#include <random>

#include <glm/glm.hpp>

namespace isophote::oracle {

/// Independent uniform numbers in [0, 1), one stream per (seed, pixel).
class RandomStream {
public:
  RandomStream(uint64_t seed, uint32_t x, uint32_t y) {
    std::seed_seq words{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32), x, y};
    engine_.seed(words);
  }

  [[nodiscard]] double next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  [[nodiscard]] glm::dvec2 next2() {
    const double first = next();
    return {first, next()};
  }

private:
  std::mt19937_64 engine_;
};

} // namespace isophote::oracle
