#include "fault/heap_faults.hpp"

#include <cstdlib>
#include <new>

namespace {

thread_local uint64_t allocations = 0;
thread_local uint64_t failing = 0;

} // namespace

void isophote::fault::armHeap(uint64_t nth) {
  allocations = 0;
  failing = nth;
}

uint64_t isophote::fault::heapAllocations() { return allocations; }

void* operator new(size_t size) {
  if (size >= isophote::fault::kSmallestCounted && ++allocations == failing) throw std::bad_alloc();
  if (void* memory = std::malloc(size != 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

void* operator new[](size_t size) { return operator new(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory, size_t) noexcept { std::free(memory); }
