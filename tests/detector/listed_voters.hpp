#pragma once

#include <cstdint>
#include <vector>

#include "detector/forest/posteriors.hpp"

namespace houghstream {

/// Describes a patch that votes for a class.
struct ListedVoter {
  std::uint32_t patch;
  std::vector<std::uint32_t> entries;  ///< class entries of the leaves in its trees
  bool operator==(const ListedVoter& other) const { return patch == other.patch && entries == other.entries; }
};

inline std::vector<ListedVoter> voters_for(int class_index, const PatchPosteriors& posteriors) {
  std::vector<ListedVoter> found;
  posteriors.for_each_supporting_patch(class_index,
                                       [&](std::uint32_t patch, const std::uint32_t* entries, std::uint32_t count) {
                                         found.push_back({patch, {entries, entries + count}});
                                       });
  return found;
}

}  // namespace houghstream
