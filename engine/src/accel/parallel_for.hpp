// Independent pieces of work on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <future>
#include <thread>
#include <vector>

namespace isophote {

/// Threads to work on; 0 asks for one a core.
[[nodiscard]] inline uint32_t threadCount(uint32_t asked) {
  return asked == 0 ? std::max(1u, std::thread::hardware_concurrency()) : asked;
}

/// Calls work(0) to work(count - 1), each once, on at most so many threads, this one among them.
/// @throws what `work` throws, after all threads have ended
template <class Work> void parallelFor(uint32_t count, uint32_t threads, const Work& work) {
  std::atomic<uint32_t> next = 0;
  const auto takeTurns = [&] {
    for (uint32_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::future<void>> others;
  for (uint32_t i = 1; i < std::min(threads, count); ++i) others.push_back(std::async(std::launch::async, takeTurns));
  takeTurns();
  for (std::future<void>& other : others) other.get();
}

} // namespace isophote
