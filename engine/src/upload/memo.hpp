// Tables that are computed once.
#pragma once

#include <map>
#include <mutex>

namespace isophote {

/// Keeps one value for each key, computed when it is first asked for. Safe to use from several threads.
template <class Key, class Value> class Memo {
public:
  /// @param compute called once for each key
  template <class Compute> const Value& get(const Key& key, Compute&& compute) {
    const std::lock_guard lock(mutex_);
    auto entry = values_.find(key);
    if (entry == values_.end()) entry = values_.emplace(key, compute()).first;
    return entry->second;
  }

private:
  std::mutex mutex_;
  std::map<Key, Value> values_;
};

} // namespace isophote
