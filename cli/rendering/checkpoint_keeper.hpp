// The checkpoint of a render: taken up at its start, kept fresh while it runs.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "isophote/film.hpp"
#include "isophote/settings.hpp"

namespace isophote::cli {

struct CheckpointOptions {
  std::string file; ///< empty: none is kept
  double everySeconds = 60;
  bool resume = false; ///< go on from the file where there is one
};

/// Where a render goes on.
struct RenderStart {
  SampleRange left;
  double seconds = 0; ///< rendered before
};

class CheckpointKeeper {
public:
  /// @param identity  JSON of one object: all that the samples depend on
  CheckpointKeeper(const CheckpointOptions& options, std::string identity)
      : options_(options), identity_(std::move(identity)) {}

  /// Fills the film from the file, if asked to and there is one, and returns what is left of `samples`.
  /// @throws SceneError for a damaged file; UsageError for one of another render, naming the first difference
  [[nodiscard]] RenderStart start(Film& film, SampleRange samples) const;

  [[nodiscard]] bool due() const;
  /// @throws OutputError
  void save(const Film& film, SampleRange left, double seconds);

private:
  using Clock = std::chrono::steady_clock;
  CheckpointOptions options_;
  std::string identity_;
  Clock::time_point saved_ = Clock::now();
};

} // namespace isophote::cli
