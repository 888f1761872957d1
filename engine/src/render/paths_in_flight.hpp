// How many paths a pipeline keeps in flight, where that is left to measurement.
#pragma once

#include <cstdint>

#include "isophote/device.hpp"
#include "isophote/settings.hpp"
#include "render/submit_speeds.hpp"

namespace isophote {

/// Few paths stay in a processor's caches, many fill a GPU's lanes; which is better depends on the device and never
/// changes the image. So counts race on the render's own samples: that at hand and its half take turns; the one whose
/// median submit traced more rays in its time goes on, against its half in turn; where the first half loses, doubles
/// are tried instead.
class PathsInFlight {
public:
  /// `first` is what the search begins with, in [fewest, most].
  PathsInFlight(uint32_t first, uint32_t fewest, uint32_t most);
  /// Nothing to search.
  explicit PathsInFlight(uint32_t count) : PathsInFlight(count, count, count) {}

  /// Of the next submit.
  [[nodiscard]] uint32_t count() const { return rivalsTurn_ ? rival_ : best_; }
  [[nodiscard]] bool isSettled() const { return settled_; }
  /// What a submit of count() paths did.
  void add(uint64_t rays, double milliseconds);

private:
  uint32_t fewest_;
  uint32_t most_;
  uint32_t best_;
  uint32_t rival_ = 0;
  bool settled_ = false;
  bool rivalsTurn_ = false;
  bool halving_ = true;
  bool halfHasWon_ = false;
  uint32_t submits_ = 0; ///< of this turn
  SubmitSpeeds bestSpeeds_;
  SubmitSpeeds rivalSpeeds_;

  void challenge();
  void decide();
};

/// The limits of a device.
struct PathsRange {
  uint32_t fewest = 0;
  uint32_t most = 0;  ///< what the pool has room for
  uint32_t first = 0; ///< without a measurement
};
[[nodiscard]] PathsRange pathsRange(const Device& device, Pipeline pipeline);

/// What was found on this device and driver before, where a file in the user's cache says so, else a search.
[[nodiscard]] PathsInFlight recallPathsInFlight(const Device& device, Pipeline pipeline);
/// Keeps what a search has found. No failure is reported: the next run searches again.
void rememberPathsInFlight(const Device& device, Pipeline pipeline, uint32_t count) noexcept;

} // namespace isophote
