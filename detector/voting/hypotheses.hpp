#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "detector/voting/hough_space.hpp"
#include "detector/voting/maxima.hpp"

namespace houghstream {

/// A maximum of the 3-D vote density of one class, with everything that supports it.
struct Hypothesis {
  std::size_t class_index = 0;                              ///< index into Forest::classes
  Eigen::Vector3f centre_camera = Eigen::Vector3f::Zero();  ///< metres
  float vote_mass = 0.0F;  ///< votes' weight times the area of their patches, square metres: what is seen of the object
  float weight = 0.0F;     ///< votes' weight
  int vote_count = 0;
  std::vector<std::pair<std::uint32_t, float>> patches;  ///< supporting patch and its weight, by patch
  std::vector<std::pair<std::uint32_t, float>> views;    ///< supported view template and its weight, heaviest first
};

/// Sums by index that are 0 where nothing was added, kept so from use to use.
class SparseSums {
 public:
  using Weights = std::vector<std::pair<std::uint32_t, float>>;

  void resize(std::size_t count);
  void add(std::uint32_t index, float value) {
    touched_[index / kBits] |= std::uint64_t{1} << index % kBits;
    sums_[index] += value;
  }
  /// Indices and sums in order of the index; they are 0 afterwards.
  void take(Weights& out);

 private:
  static constexpr std::size_t kBits = 64;
  std::vector<float> sums_;
  std::vector<std::uint64_t> touched_;  // a bit for each sum, so that they need no sorting
};

/// Workspace of find_hypotheses(), reused from frame to frame.
struct VotingWorkspace {
  struct Worker {
    HoughSpace space;
    CastWorkspace casting;
    MaximaWorkspace maxima;
    std::vector<VoteRange> ranges;
    SparseSums::Weights supports;  ///< supports of a range's votes
    SparseSums voter_sums;
    SparseSums view_sums;
    std::vector<SparseSums::Weights> by_voter;  ///< weights by voter of each maximum
    SparseSums::Weights by_patch;
  };
  PerWorker<Worker> workers;
};

/// Returns the maxima of a class's votes in workspace.space with the largest vote mass, in descending order, at most as
/// many as the settings allow and each with the minimum mass.
std::vector<Hypothesis> class_hypotheses(const VotingInput& input, std::size_t class_index,
                                         VotingWorkspace::Worker& workspace);

/// Casts the votes of every class and finds their maxima: class by class in one pass, so that a class's Hough space is
/// still in the cache. Ordered by class, each class's heaviest first: what is near has more patches, and so more
/// votes, while its mass is that of what is far. The same for any number of threads.
std::vector<Hypothesis> find_hypotheses(const VotingInput& input, int threads, VotingWorkspace& workspace);

}  // namespace houghstream
