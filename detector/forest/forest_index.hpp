#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "detector/forest/forest.hpp"
#include "detector/forest/packed_trees.hpp"

namespace houghstream {

/// Values of a leaf that detection reads, side by side, so that a leaf costs one cache miss instead of two.
struct LeafSummary {
  float max_posterior = 0.0F;     ///< the largest p(class | leaf)
  std::uint32_t first_class = 0;  ///< index as in Forest::leaves
};

/// The views of the same class with the nearest viewing directions, nearest first; filled up with the view itself.
using ViewNeighbours = std::array<std::uint32_t, 6>;

/// Views of a class that represent all attitudes in which it was taught, chosen by farthest-point sampling (Gonzalez
/// 1985).
struct SampledViews {
  static constexpr std::size_t kCount = 200;  ///< maximum
  static constexpr std::size_t kCoarse =
      48;  ///< number of the first views, of which each of the others has a nearest one

  std::vector<std::uint32_t> views;    ///< in the order of the choice, the class's first view first
  std::vector<std::uint32_t> nearest;  ///< of each view: the index into `views` of the nearest coarse one
};

/// A forest with what a search needs of it beyond its file, which the constructor derives. The forest must outlive the
/// index and stay as it is: a forest that was changed gets another index.
class ForestIndex {
 public:
  static constexpr float kMaxAttitudeFactor = 3.0F;

  explicit ForestIndex(const Forest& forest);
  explicit ForestIndex(Forest&&) = delete;

  const Forest& forest() const { return *forest_; }
  const std::vector<LeafSummary>& leaf_summaries() const { return leaf_summaries_; }  ///< number of leaves + 1
  const std::vector<LeafStart>& leaf_starts() const { return leaf_starts_; }          ///< per leaf
  const PackedTrees& packed() const { return packed_; }
  const std::vector<ViewNeighbours>& view_neighbours() const { return view_neighbours_; }  ///< per view
  const SampledViews& sampled_views(std::size_t class_index) const { return sampled_views_[class_index]; }
  /// Returns how many times as many views a class has as one that was taught in one attitude (a way of standing or
  /// lying), 1 to kMaxAttitudeFactor: how many attitudes are searched of it, however many it was taught in.
  float attitude_factor(std::size_t class_index) const { return attitude_factors_[class_index]; }

 private:
  const Forest* forest_;
  std::vector<LeafSummary> leaf_summaries_;
  std::vector<LeafStart> leaf_starts_;
  PackedTrees packed_;
  std::vector<ViewNeighbours> view_neighbours_;
  std::vector<SampledViews> sampled_views_;  // per class
  std::vector<float> attitude_factors_;      // per class
};

}  // namespace houghstream
