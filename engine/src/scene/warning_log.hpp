// Collects the one-line warnings of a loader: one line a cause, with how often and where it was met first.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace isophote {

class WarningLog {
public:
  /// Counts `times` occurrences of `cause`; the first `where` (a JSON pointer, or empty) is kept.
  void add(const std::string& cause, const std::string& where = {}, uint64_t times = 1);

  /// `WHERE: CAUSE`, or `CAUSE (N times, first at WHERE)`, in the order in which the causes were first met.
  [[nodiscard]] std::vector<std::string> lines() const;

private:
  struct Entry {
    std::string cause;
    std::string where;
    uint64_t count = 0;
  };
  std::vector<Entry> entries_;
  std::map<std::string, size_t> indexOfCause_;
};

} // namespace isophote
