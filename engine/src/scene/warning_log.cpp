#include "scene/warning_log.hpp"

namespace isophote {

void WarningLog::add(const std::string& cause, const std::string& where, uint64_t times) {
  if (times == 0) return;
  const auto [found, isNew] = indexOfCause_.try_emplace(cause, entries_.size());
  if (isNew) entries_.push_back({cause, where, 0});
  entries_[found->second].count += times;
}

std::vector<std::string> WarningLog::lines() const {
  std::vector<std::string> result;
  for (const Entry& entry : entries_) {
    const std::string count = std::to_string(entry.count) + " times";
    if (entry.count == 1) {
      result.push_back(entry.where.empty() ? entry.cause : entry.where + ": " + entry.cause);
    } else if (entry.where.empty()) {
      result.push_back(entry.cause + " (" + count + ")");
    } else {
      result.push_back(entry.cause + " (" + count + ", first at " + entry.where + ")");
    }
  }
  return result;
}

} // namespace isophote
