#include "rendering/checkpoint_keeper.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "isophote/checkpoint.hpp"
#include "isophote/error.hpp"

namespace isophote::cli {
namespace {

using Json = nlohmann::ordered_json;

/// @throws UsageError where the two differ
void checkIdentity(const std::string& file, const std::string& stored, const std::string& own) {
  if (stored == own) return;
  const Json theirs = Json::parse(stored, nullptr, false);
  const Json ours = Json::parse(own);
  if (theirs.is_object()) {
    for (const auto& [key, value] : ours.items()) {
      if (theirs.contains(key) && theirs[key] == value) continue;
      const std::string other = theirs.contains(key) ? theirs[key].dump() : "none";
      throw UsageError(fmt::format("{}: a checkpoint of another render: its {} is {}, this one's {}", file, key, other,
                                   value.dump()));
    }
  }
  throw UsageError(file + ": a checkpoint of another render");
}

} // namespace

RenderStart CheckpointKeeper::start(Film& film, SampleRange samples) const {
  if (!options_.resume || !std::filesystem::exists(options_.file)) return {.left = samples};
  const Checkpoint checkpoint = readCheckpoint(options_.file);
  checkIdentity(options_.file, checkpoint.identity, identity_);
  film.restore(checkpoint.sums);
  SampleRange left = checkpoint.left;
  left.last = std::max(samples.last, left.first); // more or fewer samples may be asked for than the last time
  if (left.first == left.last) left.begun = 0;
  return {.left = left, .seconds = checkpoint.seconds};
}

bool CheckpointKeeper::due() const {
  if (options_.file.empty()) return false;
  return std::chrono::duration<double>(Clock::now() - saved_).count() >= options_.everySeconds;
}

void CheckpointKeeper::save(const Film& film, SampleRange left, double seconds) {
  if (options_.file.empty()) return;
  writeCheckpoint(options_.file, {.identity = identity_, .left = left, .seconds = seconds, .sums = film.sums()});
  saved_ = Clock::now();
}

} // namespace isophote::cli
