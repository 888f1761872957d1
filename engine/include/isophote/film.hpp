// Where samples end up: exact sums per pixel, and what can be said of the image from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/device.hpp"
#include "isophote/image.hpp"
#include "isophote/settings.hpp"

namespace isophote {

/// Relative RMS error of an image: sqrt(mean over pixels and channels of Var[mean] / (mean^2 + e^2)), e = 1% of the
/// image's mean luminance.
struct ErrorEstimate {
  double value = 0;
  double lower = 0; ///< confidence interval of the error that this image has
  double upper = 0; ///< untrusted pixels count at a pessimistic bound
  double confidence = 0.95;
  double untrustedShare = 0; ///< pixels whose error bar rests on about one event
  bool known = false;        ///< false until two replicates hold samples
};

struct FilmOptions {
  uint32_t width = 0; ///< 1 to 65535
  uint32_t height = 0;
  PixelRect crop;           ///< empty: the full image
  bool aovs = true;         ///< albedo, normal, depth and position of the first hit
  bool clampLedger = false; ///< what EstimatorSettings::clamp removes, as the channels clamped.{R,G,B}
  bool depthLedger = false; ///< what EstimatorSettings::maxDepth leaves out, estimated, as beyond.{R,G,B}
};

/// A film's exact sums on the host: what a checkpoint keeps, and what merging adds.
struct FilmSums {
  FilmOptions options;               ///< crop filled in
  double radiancePerUnit = 0;        ///< of the integers, a power of two; 0 while there are no samples
  double lengthPerUnit = 0;          ///< likewise
  glm::dvec3 worldOrigin{0};         ///< that positions are relative to
  std::vector<std::byte> replicates; ///< ReplicateSum of shared/film_types.h
  std::vector<std::byte> aovs;       ///< AovSum; empty without those layers
  std::vector<std::byte> clamped;    ///< RemovedSum; empty without that ledger
  std::vector<std::byte> beyond;     ///< likewise
};

/// Stores the sums in the image as integers, so that images can be merged exactly: one plane for each 32-bit word of
/// a pixel's ReplicateSums (`sums.replicates.N`), AovSum (`sums.aovs.N`) and RemovedSums (`sums.clamped.N`,
/// `sums.beyond.N`) and the attribute `isophote.sums`.
void storeSums(Image& image, const FilmSums& sums);

/// The sums that storeSums stored. @throws UsageError where the image has none
[[nodiscard]] FilmSums storedSums(const Image& image);

/// Adds the samples of `other`, which must be others than those of `sums`, of the same image.
/// @throws UsageError where the images differ in size or scale; LimitError where a sum overflows
void addSums(FilmSums& sums, const FilmSums& other);

/// Per pixel and independent replicate, 64-bit fixed-point sums that are exact and associative. Borrows the Device.
class Film {
public:
  /// @throws LimitError with needed and available bytes
  Film(const Device& device, const FilmOptions& options);
  Film(Film&&) noexcept;
  Film& operator=(Film&&) noexcept;
  ~Film();

  [[nodiscard]] const FilmOptions& options() const;
  [[nodiscard]] uint64_t bytes() const;
  void clear();

  /// All that the film holds; wait for PathTracer to finish first.
  [[nodiscard]] FilmSums sums() const;
  /// Replaces what the film holds. @throws UsageError where the image is another one
  void restore(const FilmSums& sums);

  /// Mean, standard error, 95% interval, sample count, trust and AOVs as the channels of interface.md.
  /// Reads the sums back once; wait for PathTracer to finish first.
  [[nodiscard]] Image resolve() const;

  /// Estimated on the device from the replicates, cheap enough to call every second.
  /// @param confidence  of the two-sided interval, in (0, 1)
  [[nodiscard]] ErrorEstimate error(double confidence = 0.95) const;

  /// Writes tone-mapped RGBA8 (packed, R lowest) of the crop, row 0 at the top, to the buffer at `address`: what a
  /// viewer shows. Recorded and waited for.
  void display(uint64_t address, float exposureEv, ToneMap operation) const;

  struct Impl;
  [[nodiscard]] Impl& impl() const { return *impl_; }

private:
  std::unique_ptr<Impl> impl_;
};

} // namespace isophote
