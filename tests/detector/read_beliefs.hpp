#pragma once

#include <cstdint>
#include <vector>

#include "detector/forest/beliefs.hpp"

namespace houghstream {

struct Belief {
  std::uint32_t patch;
  std::vector<std::uint32_t> entries;  ///< which leaves the trees lead to
  bool operator==(const Belief& other) const { return patch == other.patch && entries == other.entries; }
};

/// Who believes in a class, and on what ground.
inline std::vector<Belief> beliefs_in(int class_index, const PatchBeliefs& beliefs) {
  std::vector<Belief> found;
  beliefs.for_believers(class_index, [&](std::uint32_t patch, const std::uint32_t* entries, std::uint32_t count) {
    found.push_back({patch, {entries, entries + count}});
  });
  return found;
}

}  // namespace houghstream
