// Allocations of this thread that fail on demand. Linking this file replaces operator new.
#pragma once

#include <cstddef>
#include <cstdint>

namespace isophote::fault {

/// Allocations below are not counted. Small ones fail on no machine that serves large ones, and the JSON library's
/// destructor makes some, which could only end the process.
inline constexpr size_t kSmallestCounted = 2048;

/// From now on the `nth` allocation of this thread, counted from 1, throws std::bad_alloc. 0: none does.
void armHeap(uint64_t nth);

/// Allocations counted since it was armed.
[[nodiscard]] uint64_t heapAllocations();

} // namespace isophote::fault
