// Adding the samples of two films of one image.
#include <cstring>
#include <limits>

#include "isophote/error.hpp"
#include "isophote/film.hpp"
#include "shared/film_types.h"

namespace isophote {
namespace {

void addTo(int64_t& sum, int64_t other) {
  if (__builtin_add_overflow(sum, other, &sum)) throw LimitError("the sum of the samples exceeds 64 bits");
}

void addTo(uint32_t& count, uint32_t other) {
  if (__builtin_add_overflow(count, other, &count)) throw LimitError("a pixel would hold more than 2^32 samples");
}

void add(gpu::ReplicateSum& sum, const gpu::ReplicateSum& other) {
  addTo(sum.red, other.red);
  addTo(sum.green, other.green);
  addTo(sum.blue, other.blue);
  addTo(sum.count, other.count);
  addTo(sum.hitCount, other.hitCount);
}

void add(gpu::AovSum& sum, const gpu::AovSum& other) {
  for (int c = 0; c < 3; ++c) {
    addTo(sum.albedo[c], other.albedo[c]);
    addTo(sum.normal[c], other.normal[c]);
    addTo(sum.position[c], other.position[c]);
  }
  addTo(sum.depth, other.depth);
  addTo(sum.count, other.count);
}

void add(gpu::RemovedSum& sum, const gpu::RemovedSum& other) {
  addTo(sum.red, other.red);
  addTo(sum.green, other.green);
  addTo(sum.blue, other.blue);
}

template <class T> void addItems(std::vector<std::byte>& sums, const std::vector<std::byte>& others) {
  for (size_t at = 0; at < sums.size(); at += sizeof(T)) {
    T sum;
    T other;
    std::memcpy(&sum, sums.data() + at, sizeof(T));
    std::memcpy(&other, others.data() + at, sizeof(T));
    add(sum, other);
    std::memcpy(sums.data() + at, &sum, sizeof(T));
  }
}

bool sameScale(const FilmSums& a, const FilmSums& b) {
  return a.radiancePerUnit == b.radiancePerUnit && a.lengthPerUnit == b.lengthPerUnit && a.worldOrigin == b.worldOrigin;
}

} // namespace

void addSums(FilmSums& sums, const FilmSums& other) {
  if (sums.options.width != other.options.width || sums.options.height != other.options.height ||
      !(sums.options.crop == other.options.crop) || sums.replicates.size() != other.replicates.size() ||
      sums.aovs.size() != other.aovs.size() || sums.clamped.size() != other.clamped.size() ||
      sums.beyond.size() != other.beyond.size()) {
    throw UsageError("images of different size, crop or layers");
  }
  if (!(other.radiancePerUnit > 0)) return; // no samples
  if (!(sums.radiancePerUnit > 0)) {
    sums = other;
    return;
  }
  if (!sameScale(sums, other)) throw UsageError("images of different scenes");
  FilmSums total = sums; // the sums are as they were where one overflows
  addItems<gpu::ReplicateSum>(total.replicates, other.replicates);
  addItems<gpu::AovSum>(total.aovs, other.aovs);
  addItems<gpu::RemovedSum>(total.clamped, other.clamped);
  addItems<gpu::RemovedSum>(total.beyond, other.beyond);
  sums = std::move(total);
}

} // namespace isophote
