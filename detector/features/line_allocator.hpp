#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace houghstream {

/// Memory that begins with a cache line, so that aligned pixels and vectors lie in one line each.
template <typename T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <typename U>
  explicit LineAllocator(const LineAllocator<U>&) {}

  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, kLine); }

  bool operator==(const LineAllocator&) const { return true; }
  bool operator!=(const LineAllocator&) const { return false; }
};

using LineBytes = std::vector<std::uint8_t, LineAllocator<std::uint8_t>>;

}  // namespace houghstream
