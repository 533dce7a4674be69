#include "detector/voting/hough_space.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

/// Sums the votes by cell; the last element is that of the votes outside the image.
void sum_by_cell(const CastVotes& cast, const CellGrid& grid, std::vector<CellSum>& sums) {
  sums.assign(grid.outside() + 1, CellSum{});
  CellSum* const by_cell = sums.data();
  const std::uint32_t* cell = cast.cells.data();
  const Vote* const end = cast.votes.data() + cast.count;
  for (const Vote* vote = cast.votes.data(); vote != end; ++vote, ++cell) {
    ++by_cell[*cell].votes;
    by_cell[*cell].weight += vote->weight;
  }
}

/// Computes where each cell's votes begin (the exclusive prefix sum of a counting sort); those outside the image come
/// last. Copies the cells' weights to the image. `next_slot` is where sort_by_cell() puts each cell's next vote.
void compute_cell_offsets(const std::vector<CellSum>& sums, std::vector<std::uint32_t>& next_slot, HoughSpace& space) {
  next_slot.resize(sums.size());
  space.image.resize(sums.size() - 1);
  std::uint32_t count = 0;
  for (std::size_t c = 0; c < sums.size(); ++c) {
    next_slot[c] = count;
    count += sums[c].votes;
    if (c < space.image.size()) space.image[c] = sums[c].weight;
  }
  space.first_vote = next_slot;
  space.votes.resize(count + kVotePadding);
  space.voter_of_vote.resize(count);
}

/// Sorts the votes by cell. The counting sort is stable, so that the order depends on nothing but the votes.
void sort_by_cell(const CastVotes& cast, std::vector<std::uint32_t>& next_slot, HoughSpace& space) {
  std::uint32_t* const slots = next_slot.data();
  Vote* const votes = space.votes.data();
  std::uint32_t* const voters = space.voter_of_vote.data();
  const std::uint32_t* cell = cast.cells.data();
  const std::uint32_t* voter = cast.voters.data();
  const Vote* const end = cast.votes.data() + cast.count;
  constexpr std::size_t kAhead = 24;  // votes, so that the cache misses of many places overlap
  const Vote* const last_ahead = end - std::min(kAhead, cast.count);
  for (const Vote* vote = cast.votes.data(); vote != end; ++vote) {
    if (vote < last_ahead) {
      const std::uint32_t soon = slots[cell[kAhead]];
      hwy::Prefetch(votes + soon);
      hwy::Prefetch(voters + soon);
    }
    const std::uint32_t place = slots[*cell++]++;
    // four numbers at once, not one by one
    Eigen::Map<Eigen::Array4f>(votes[place].centre_camera.data()) =
        Eigen::Map<const Eigen::Array4f>(vote->centre_camera.data());
    voters[place] = *voter++;
  }
  space.votes.resize(space.first_vote.back() + kVotePadding);  // leaves out the votes outside
  space.voter_of_vote.resize(space.first_vote.back());
}

void smooth(double sigma_px, HoughSpace& space) {
  cv::Mat image(space.height, space.width, CV_32FC1, space.image.data());
  const double sigma = sigma_px / space.cell_px;
  cv::GaussianBlur(image, image, cv::Size(0, 0), sigma, sigma, cv::BORDER_CONSTANT);
}

}  // namespace

void cast_votes(const VotingInput& input, int class_index, CastWorkspace& workspace, HoughSpace& space) {
  space.cell_px = 2;
  const CellGrid grid(input.camera, space.cell_px);
  space.width = grid.width;
  space.height = grid.height;
  space.voters.clear();
  input.posteriors.for_each_supporting_patch(class_index,
                                             [&](std::uint32_t p, const SupportingEntry* entries, std::uint32_t count) {
                                               for (std::uint32_t e = 0; e < count; ++e)
                                                 space.voters.push_back({p, entries[e]});
                                             });
  cast_all({input.forest, input.patches, space.voters, grid}, workspace.cast);
  sum_by_cell(workspace.cast, grid, workspace.sums);
  compute_cell_offsets(workspace.sums, workspace.next_slot, space);
  sort_by_cell(workspace.cast, workspace.next_slot, space);
  smooth(input.settings.hough_sigma_px, space);
}

}  // namespace houghstream
