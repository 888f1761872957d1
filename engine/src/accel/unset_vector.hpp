// Large arrays that are filled on several threads.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace isophote {

/// Leaves values as they are where none are given, so that the first to touch memory is who fills it.
template <class T> struct UnsetAllocator : std::allocator<T> {
  template <class U> struct rebind { using other = UnsetAllocator<U>; };
  template <class U> void construct(U* place) noexcept {
    static_assert(std::is_trivially_copyable_v<U>);
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments> void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// Elements that resize adds have no value yet.
template <class T> using UnsetVector = std::vector<T, UnsetAllocator<T>>;

} // namespace isophote
