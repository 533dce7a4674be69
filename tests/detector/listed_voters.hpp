#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "detector/forest/posteriors.hpp"

namespace houghstream {

/// Describes a patch that votes for a class.
struct ListedVoter {
  std::uint32_t patch;
  std::vector<SupportingEntry> entries;  ///< class entries of the leaves in its trees
  bool operator==(const ListedVoter& other) const {
    const auto is_same = [](const SupportingEntry& a, const SupportingEntry& b) {
      return a.start.vote == b.start.vote && a.start.view == b.start.view &&
             a.leaf_class.probability == b.leaf_class.probability;
    };
    return patch == other.patch &&
           std::equal(entries.begin(), entries.end(), other.entries.begin(), other.entries.end(), is_same);
  }
};

inline std::vector<ListedVoter> voters_for(int class_index, const PatchPosteriors& posteriors) {
  std::vector<ListedVoter> found;
  posteriors.for_each_supporting_patch(class_index,
                                       [&](std::uint32_t patch, const SupportingEntry* entries, std::uint32_t count) {
                                         found.push_back({patch, {entries, entries + count}});
                                       });
  return found;
}

}  // namespace houghstream
