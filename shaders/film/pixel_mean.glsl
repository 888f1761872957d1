// Mean and variance of a pixel from its replicates.
#ifndef ISOPHOTE_FILM_PIXEL_MEAN_GLSL
#define ISOPHOTE_FILM_PIXEL_MEAN_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "shared/film_types.h"

#ifndef ISOPHOTE_KERNELS_WAVEFRONT_GLSL
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ReplicateRef { ReplicateSum items[]; };
#endif

struct PixelMean {
  vec3 mean;
  vec3 varianceOfMean; // 0 where fewer than two replicates hold samples
  float largestShare;  // of one replicate in the squared deviations of a channel
  uint replicates;     // that hold samples
  uint sampleCount;
};

/// The count-weighted mean over replicates, and the unbiased variance of it for equally filled replicates:
/// sum w_r^2 (m_r - m)^2 / (1 - sum w_r^2) with w_r the replicate's share of the samples.
PixelMean pixelMean(const ReplicateRef sums, const uint pixel, const float valueScale) {
  PixelMean result = PixelMean(vec3(0.0), vec3(0.0), 0.0, 0u, 0u);
  int64_t red = 0l, green = 0l, blue = 0l;
  for (uint r = 0u; r < kReplicateCount; ++r) {
    const uint index = pixel * kReplicateCount + r;
    red += sums.items[index].red;
    green += sums.items[index].green;
    blue += sums.items[index].blue;
    result.sampleCount += sums.items[index].count;
    if (sums.items[index].count > 0u) result.replicates += 1u;
  }
  if (result.sampleCount == 0u) return result;
  const float total = float(result.sampleCount);
  result.mean = vec3(float(red), float(green), float(blue)) * (valueScale / total);
  if (result.replicates < 2u) return result;
  float squares = 0.0;
  vec3 largest = vec3(0.0);
  for (uint r = 0u; r < kReplicateCount; ++r) {
    const uint index = pixel * kReplicateCount + r;
    const float count = float(sums.items[index].count);
    if (count == 0.0) continue;
    const vec3 mean =
        vec3(float(sums.items[index].red), float(sums.items[index].green), float(sums.items[index].blue)) *
        (valueScale / count);
    const float share = count / total;
    squares += share * share;
    const vec3 deviation = share * (mean - result.mean);
    result.varianceOfMean += deviation * deviation;
    largest = max(largest, deviation * deviation);
  }
  for (uint c = 0u; c < 3u; ++c) {
    if (result.varianceOfMean[c] > 0.0)
      result.largestShare = max(result.largestShare, largest[c] / result.varianceOfMean[c]);
  }
  result.varianceOfMean /= 1.0 - squares;
  return result;
}

#endif
