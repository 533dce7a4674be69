#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "detector/forest/forest.hpp"
#include "detector/forest/posteriors.hpp"
#include "detector/voting/voting_settings.hpp"
#include "pipeline/types/camera.hpp"

namespace houghstream {

constexpr float kVoteReach = 2.5F;  ///< reach of vote_kernel, in sigmas

/// Returns the weight of a vote at this distance from a maximum: (1 - d^2 / reach^2)^2 with a reach of 2.5 sigma. It
/// approximates a Gaussian, needs no exponential and is zero beyond the reach.
inline float vote_kernel(float distance_sq, float vote_sigma) {
  const float reach = kVoteReach * vote_sigma;
  const float q = 1.0F - distance_sq / (reach * reach);
  return q > 0.0F ? q * q : 0.0F;
}

/// One vote for an object's centre in the camera frame.
struct Vote {
  Eigen::Vector3f centre_camera;  ///< metres
  float weight = 0.0F;            ///< p(class | leaf) times the vote's share, over the number of trees; 0 to 1
};

/// A patch and one of its leaves that knows the class.
struct Voter {
  std::uint32_t patch = 0;  ///< index into the PatchGrid
  SupportingEntry entry;
};

constexpr std::size_t kVotePadding = 7;  ///< votes behind the last: vectors of eight are read whole

/// The Hough space of one class: its votes in 3-D, sorted by the image cell in which their centre is seen.
struct HoughSpace {
  int width = 0;  ///< cells
  int height = 0;
  int cell_px = 0;  ///< working pixels per cell
  /// Votes by cell, row by row; within a cell in order of patch and tree; then kVotePadding that do not count.
  std::vector<Vote> votes;
  std::vector<std::uint32_t> voter_of_vote;  ///< per vote: index of its voter, into `voters`
  std::vector<Voter> voters;              ///< voters by patch, tree by tree; some may have cast no vote into the image
  std::vector<std::uint32_t> first_vote;  ///< per cell, and one more
  std::vector<float> image;               ///< sum of weights per cell, smoothed; independent of distance, since both
                                          ///< a patch's footprint and the spread of its votes shrink with it
};

/// Input of the voting.
struct VotingInput {
  const Forest& forest;
  const PatchGrid& patches;
  const PatchPosteriors& posteriors;
  const Camera& camera;  ///< camera in whose pixels Hough spaces are laid out: that of the level for near surfaces
  const VotingSettings& settings;
  /// Number of classes of all the forests that are searched in the frame, which share its candidates; 0: this one's.
  std::size_t searched_classes = 0;
};

/// Votes in the order of their voters.
struct CastVotes {
  static constexpr std::size_t kPadding = 4;  ///< elements behind the last: vectors are written whole

  std::size_t count = 0;  ///< number of elements that count; the vectors may hold more
  std::vector<Vote> votes;
  std::vector<std::uint32_t> cells;   ///< CellGrid::outside() of votes not seen in the image or nearer than 10 cm
  std::vector<std::uint32_t> voters;  ///< per vote: index of its voter
};

/// Votes of a cell.
struct CellSum {
  std::uint32_t votes = 0;
  float weight = 0.0F;
};

/// Workspace of cast_votes(), reused from class to class.
struct CastWorkspace {
  CastVotes cast;
  std::vector<CellSum> sums;
  std::vector<std::uint32_t> next_slot;
};

/// Votes for one class of all patches that support it (paper, Section 2; Gall et al. 2011, Section 3.3, here in 3-D).
/// `space` is overwritten, and its memory is reused.
void cast_votes(const VotingInput& input, int class_index, CastWorkspace& workspace, HoughSpace& space);

/// The image of cells in which votes are counted.
struct CellGrid {
  CellGrid(const Camera& camera, int cell_px);

  std::uint32_t outside() const { return static_cast<std::uint32_t>(width * height); }

  int width = 0;  ///< cells
  int height = 0;
  float fx = 0.0F;  ///< focal length in cells; a cell's centre is at a half
  float fy = 0.0F;
  float cx = 0.0F;
  float cy = 0.0F;
};

/// Patches that cast votes, and the grid that receives them.
struct CastInput {
  const Forest& forest;
  const PatchGrid& patches;
  const std::vector<Voter>& voters;
  const CellGrid& grid;
};

/// Casts the votes of all voters, several at once: the same on every machine, since each vote's numbers depend on it
/// alone. `cast` is overwritten, and its memory is reused.
void cast_all(const CastInput& input, CastVotes& cast);

}  // namespace houghstream
