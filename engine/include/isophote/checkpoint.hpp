// A render under way on disk: enough to end it with the bits it would have had without a break.
#pragma once

#include <filesystem>
#include <string>

#include "isophote/film.hpp"
#include "isophote/settings.hpp"

namespace isophote {

struct Checkpoint {
  std::string identity; ///< what made the samples, JSON of one object: the caller compares it with its own
  SampleRange left;     ///< of the samples asked for, as PathTracer::left has it
  double seconds = 0;   ///< rendered so far
  FilmSums sums;
};

/// Writes atomically: a crash at any moment leaves the earlier file.
/// @throws OutputError
void writeCheckpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// @throws SceneError where the file is none, ends early, or is damaged
[[nodiscard]] Checkpoint readCheckpoint(const std::filesystem::path& file);

} // namespace isophote
