#pragma once

#include <cstddef>
#include <cstdint>

namespace houghstream {

/// Computes FNV-1a of 64 bits (Fowler, Noll and Vo 1991), continued from `hash`: consecutive parts yield the number of
/// the whole.
inline std::uint64_t fnv1a(const void* bytes, std::size_t size, std::uint64_t hash = 0xcbf29ce484222325ULL) {
  const auto* at = static_cast<const std::uint8_t*>(bytes);
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ at[i]) * 0x100000001b3ULL;
  return hash;
}

}  // namespace houghstream
