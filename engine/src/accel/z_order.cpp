#include "accel/z_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <utility>

#include "accel/parallel_for.hpp"

namespace isophote {
namespace {

constexpr uint32_t kBitsPerAxis = 21;
constexpr double kCells = 1u << kBitsPerAxis;

constexpr uint32_t kDigitBits = 11;
constexpr uint32_t kDigits = 1u << kDigitBits;

// Some 0.1 ms for each pass.
constexpr uint32_t kMinItemsPerThread = 16384;

// Puts two zeros before each of the lowest 21 bits.
uint64_t spread(uint64_t bits) {
  bits = (bits | bits << 32) & 0x1f00000000ffffull;
  bits = (bits | bits << 16) & 0x1f0000ff0000ffull;
  bits = (bits | bits << 8) & 0x100f00f00f00f00full;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3ull;
  return (bits | bits << 2) & 0x1249249249249249ull;
}

class Cells {
public:
  explicit Cells(const Box& all) : lower_(all.lower) {
    const glm::dvec3 size = glm::dvec3(all.upper) - lower_;
    for (int axis = 0; axis < 3; ++axis) cellsPerUnit_[axis] = size[axis] > 0 ? kCells / size[axis] : 0;
  }

  // The bits of the three numbers of the cell that holds the center, in turn.
  [[nodiscard]] uint64_t code(const Box& box) const {
    const glm::dvec3 center = 0.5 * (glm::dvec3(box.lower) + glm::dvec3(box.upper));
    uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = (center[axis] - lower_[axis]) * cellsPerUnit_[axis];
      code |= spread(static_cast<uint64_t>(std::min(cell, kCells - 1))) << axis;
    }
    return code;
  }

private:
  glm::dvec3 lower_, cellsPerUnit_;
};

// Equal parts of the list for one thread each.
struct Parts {
  uint32_t items, count;

  Parts(size_t all, uint32_t threads)
      : items(static_cast<uint32_t>(all)), count(std::clamp(items / kMinItemsPerThread, 1u, threads)) {}
  [[nodiscard]] uint32_t first(uint32_t part) const {
    return static_cast<uint32_t>(static_cast<uint64_t>(items) * part / count);
  }
};

// Words of a code's first bits above the number of its box: what fits is sorted at once.
class Words {
public:
  explicit Words(uint32_t boxes) : numberBits_(static_cast<uint32_t>(std::bit_width(boxes))) {}

  [[nodiscard]] uint32_t numberBits() const { return numberBits_; }
  [[nodiscard]] uint64_t word(uint64_t code, uint32_t number) const {
    return code << 1 >> numberBits_ << numberBits_ | number; // of a code's 64 bits the first is always 0
  }
  [[nodiscard]] uint32_t number(uint64_t word) const {
    return static_cast<uint32_t>(word & ((uint64_t{1} << numberBits_) - 1));
  }
  [[nodiscard]] bool sameCode(uint64_t a, uint64_t b) const { return (a ^ b) >> numberBits_ == 0; }

private:
  uint32_t numberBits_;
};

uint32_t digit(uint64_t word, uint32_t shift) { return static_cast<uint32_t>(word >> shift) & (kDigits - 1); }

// Orders by one digit what was ordered by those below it. Returns whether `to` has it: where all digits are the same,
// it has not.
bool sortByDigit(const uint64_t* from, uint64_t* to, const Parts& parts, uint32_t shift) {
  std::vector<std::array<uint32_t, kDigits>> starts(parts.count); // first as counts
  parallelFor(parts.count, parts.count, [&](uint32_t part) {
    for (uint32_t i = parts.first(part); i < parts.first(part + 1); ++i) ++starts[part][digit(from[i], shift)];
  });
  uint32_t start = 0;
  for (uint32_t d = 0; d < kDigits; ++d) {
    const uint32_t before = start;
    for (std::array<uint32_t, kDigits>& counts : starts) start += std::exchange(counts[d], start);
    if (start - before == parts.items) return false;
  }
  parallelFor(parts.count, parts.count, [&](uint32_t part) {
    for (uint32_t i = parts.first(part); i < parts.first(part + 1); ++i) {
      to[starts[part][digit(from[i], shift)]++] = from[i];
    }
  });
  return true;
}

// Orders boxes whose words differ in their numbers alone by all of their codes.
void sortByCode(std::span<uint32_t> order, std::span<const Box> boxes, const Cells& cells) {
  std::vector<std::pair<uint64_t, uint32_t>> places; // code, number
  places.reserve(order.size());
  for (const uint32_t number : order) places.emplace_back(cells.code(boxes[number]), number);
  std::sort(places.begin(), places.end());
  for (size_t i = 0; i < order.size(); ++i) order[i] = places[i].second;
}

} // namespace

std::vector<uint32_t> zOrder(std::span<const Box> boxes, uint32_t threads) {
  const Parts parts(boxes.size(), threadCount(threads));
  const auto forParts = [&](const auto& work) { parallelFor(parts.count, parts.count, work); };
  std::vector<Box> bounds(parts.count);
  forParts([&](uint32_t part) {
    Box all;
    for (uint32_t i = parts.first(part); i < parts.first(part + 1); ++i) all.grow(boxes[i]);
    bounds[part] = all;
  });
  Box all;
  for (const Box& box : bounds) all.grow(box);

  const Cells cells(all);
  const Words words(parts.items);
  auto sorted = std::make_unique_for_overwrite<uint64_t[]>(parts.items);
  auto spare = std::make_unique_for_overwrite<uint64_t[]>(parts.items);
  forParts([&](uint32_t part) {
    for (uint32_t i = parts.first(part); i < parts.first(part + 1); ++i) {
      sorted[i] = words.word(cells.code(boxes[i]), i);
    }
  });
  for (uint32_t shift = words.numberBits(); shift < 64; shift += kDigitBits) {
    if (sortByDigit(sorted.get(), spare.get(), parts, shift)) std::swap(sorted, spare);
  }

  std::vector<uint32_t> order(parts.items);
  forParts([&](uint32_t part) {
    for (uint32_t i = parts.first(part); i < parts.first(part + 1); ++i) order[i] = words.number(sorted[i]);
  });
  for (uint32_t first = 0, last; first < parts.items; first = last) {
    for (last = first + 1; last < parts.items && words.sameCode(sorted[first], sorted[last]); ++last) continue;
    if (last - first > 1) sortByCode(std::span(order).subspan(first, last - first), boxes, cells);
  }
  return order;
}

} // namespace isophote
