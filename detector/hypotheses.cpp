#include "detector/hypotheses.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <utility>

#include "detector/maxima.hpp"
#include "detector/mean_shift.hpp"

namespace houghstream {
namespace {

/// The value with half the weight below it; 0 where there are none.
float weighted_median(std::vector<std::pair<float, float>>& values, float total) {
  std::sort(values.begin(), values.end());
  float sum = 0.0F;
  for (const auto& [value, weight] : values) {
    sum += weight;
    if (sum >= 0.5F * total) return value;
  }
  return 0.0F;
}

using Weights = std::vector<std::pair<std::uint32_t, float>>;

/// Sums by index that are 0 where nothing was added, kept so from use to use.
class SparseSums {
 public:
  void make_room(std::size_t count) {
    if (sums_.size() < count) sums_.resize(count, 0.0F);
  }

  void add(std::uint32_t index, float value) {
    if (sums_[index] == 0.0F) touched_.push_back(index);
    sums_[index] += value;
  }

  /// Indices and sums in order of the index; forgets them.
  void take(Weights& out) {
    std::sort(touched_.begin(), touched_.end());
    out.clear();
    for (const std::uint32_t index : touched_) {
      out.emplace_back(index, sums_[index]);
      sums_[index] = 0.0F;
    }
    touched_.clear();
  }

 private:
  std::vector<float> sums_;
  std::vector<std::uint32_t> touched_;
};

/// Sums the support of a maximum by voter; returns the number of votes.
int sum_by_voter(const HoughSpace& space, const Camera& camera, const Eigen::Vector3f& centre, float vote_sigma,
                 Weights& by_voter) {
  static thread_local std::vector<VoteRange> ranges;  // both kept from maximum to maximum
  static thread_local SparseSums sums;
  sums.make_room(space.voters.size());
  ranges_around(space, camera, centre, vote_sigma, ranges);
  int count = 0;
  for (const VoteRange& range : ranges) {
    for (std::uint32_t v = range.begin; v < range.end; ++v) {
      const Vote& vote = space.votes[v];
      const float k = vote_kernel((vote.centre_camera - centre).squaredNorm(), vote_sigma);
      if (k <= 0.0F) continue;
      sums.add(space.voter[v], k * vote.weight);
      ++count;
    }
  }
  sums.take(by_voter);
  return count;
}

/// Sums the support by remembered view, heaviest first.
void sum_by_view(const Forest& forest, const HoughSpace& space, const Weights& by_voter, Weights& by_view) {
  constexpr std::size_t kAhead = 8;  // voters, so that their cache misses overlap
  static thread_local SparseSums sums;
  sums.make_room(forest.views.size());
  for (std::size_t i = 0; i < by_voter.size(); ++i) {
    if (i + 2 * kAhead < by_voter.size()) {
      const auto class_of = [&](std::size_t s) {
        return &forest.leaf_classes[space.voters[by_voter[s].first].leaf_class];
      };
      hwy::Prefetch(class_of(i + 2 * kAhead));
      hwy::Prefetch(forest.leaf_views.data() + class_of(i + kAhead)->first_view);
      hwy::Prefetch(forest.leaf_views.data() + class_of(i + kAhead)->first_view + 8);
    }
    const LeafClass& entry = forest.leaf_classes[space.voters[by_voter[i].first].leaf_class];
    for (std::uint32_t v = entry.first_view; v < entry.first_view + entry.view_count; ++v) {
      sums.add(forest.leaf_views[v].view, by_voter[i].second * forest.leaf_views[v].weight);
    }
  }
  sums.take(by_view);
  std::stable_sort(by_view.begin(), by_view.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
}

/// A maximum with what supports it; its mass is what is seen of the object, the weight times the area of the patches.
/// One without `least_mass` is left without views.
Hypothesis gather_support(const Forest& forest, const HoughSpace& space, const PatchGrid& patches, const Camera& camera,
                          const Eigen::Vector3f& centre, float least_mass, float vote_sigma) {
  static thread_local Weights by_voter;  // kept from maximum to maximum
  Hypothesis hypothesis;
  hypothesis.centre_camera = centre;
  hypothesis.vote_count = sum_by_voter(space, camera, centre, vote_sigma, by_voter);
  for (const auto& [index, weight] : by_voter) {
    const std::uint32_t patch = space.voters[index].patch;
    hypothesis.weight += weight;
    hypothesis.mass += weight * patches.area[patch];
    Weights& supporters = hypothesis.patches;
    if (supporters.empty() || supporters.back().first != patch) supporters.emplace_back(patch, 0.0F);
    supporters.back().second += weight;
  }
  if (hypothesis.mass >= least_mass) sum_by_view(forest, space, by_voter, hypothesis.views);
  return hypothesis;
}

/// Left, top, right and bottom of a box, frame pixels; 0 is the left edge of the first pixel.
using Sides = std::array<float, 4>;

/// Where the supporting patches lie. Patches that hardly believe in the object lie beside it; the median supporter
/// says what believing is here.
Sides supporting_sides(const Hypothesis& hypothesis, const PatchGrid& patches) {
  std::vector<float> weights;
  for (const auto& [patch, weight] : hypothesis.patches) weights.push_back(weight);
  std::nth_element(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2), weights.end());
  const float least = 0.3F * weights[weights.size() / 2];
  std::array<std::vector<float>, 4> values;
  for (const auto& [patch, weight] : hypothesis.patches) {
    if (weight < least) continue;
    const cv::Rect2f& cell = patches.cell_px[patch];
    values[0].push_back(cell.x);
    values[1].push_back(cell.y);
    values[2].push_back(cell.br().x);
    values[3].push_back(cell.br().y);
  }
  Sides sides{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::size_t outliers = values[i].size() / 50;
    const std::size_t rank = i < 2 ? outliers : values[i].size() - 1 - outliers;
    std::nth_element(values[i].begin(), values[i].begin() + static_cast<std::ptrdiff_t>(rank), values[i].end());
    sides[i] = values[i][rank];
  }
  return sides;
}

/// Where the remembered training views have their sides: weighted medians.
Sides remembered_sides(const Forest& forest, const Hypothesis& hypothesis, const Camera& camera) {
  const Eigen::Vector3d centre = hypothesis.centre_camera.cast<double>();
  const Eigen::Vector2d centre_px = camera.project(centre);
  const auto px_per_metre = static_cast<float>(1.0 / camera.metres_per_px(centre.z()));
  Sides sides{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    std::vector<std::pair<float, float>> values;
    float total = 0.0F;
    for (const auto& [view, weight] : hypothesis.views) {
      values.emplace_back(forest.views[view].box[i], weight);
      total += weight;
    }
    // pixel centres are whole numbers to the camera, while a box counts from the first pixel's edge
    const auto origin_px = static_cast<float>(centre_px[static_cast<Eigen::Index>(i % 2)]) + 0.5F;
    sides[i] = origin_px + px_per_metre * weighted_median(values, total);
  }
  return sides;
}

}  // namespace

std::vector<Hypothesis> find_hypotheses(const Forest& forest, const HoughSpace& space, const PatchGrid& patches,
                                        const Camera& working_camera, float least_mass,
                                        const DetectionSettings& settings) {
  std::vector<Hypothesis> hypotheses;
  for (const Eigen::Vector3f& centre : find_maxima(space, working_camera, settings)) {
    Hypothesis hypothesis =
        gather_support(forest, space, patches, working_camera, centre, least_mass, settings.vote_sigma);
    if (hypothesis.mass >= least_mass) hypotheses.push_back(std::move(hypothesis));
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.mass > b.mass; });
  return hypotheses;
}

cv::Rect2f backprojected_box(const Forest& forest, const Hypothesis& hypothesis, const PatchGrid& patches,
                             const Camera& camera) {
  if (hypothesis.patches.empty() || hypothesis.views.empty()) return {};
  constexpr float kHidden = 0.3F;  // of the object's width or height: from here on a side is taken to be hidden
  const Sides seen = supporting_sides(hypothesis, patches);
  const Sides whole = remembered_sides(forest, hypothesis, camera);
  Sides sides{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const float size = whole[(i % 2) + 2] - whole[i % 2];
    const float outwards = i < 2 ? seen[i] - whole[i] : whole[i] - seen[i];
    sides[i] = outwards < kHidden * size ? whole[i] : seen[i];
  }
  const cv::Rect2f box(sides[0], sides[1], sides[2] - sides[0], sides[3] - sides[1]);
  return box & cv::Rect2f(0.0F, 0.0F, static_cast<float>(camera.width), static_cast<float>(camera.height));
}

std::vector<Detection> suppress_overlaps(std::vector<Detection> detections, const DetectionSettings& settings) {
  std::stable_sort(detections.begin(), detections.end(),
                   [](const Detection& a, const Detection& b) { return a.score > b.score; });
  std::vector<Detection> kept;
  for (Detection& detection : detections) {
    const auto overlaps = [&](const Detection& other) {
      const bool dominates = other.class_id == detection.class_id ||
                             (other.score > 0.5F && other.score > settings.dominance * detection.score);
      return dominates && box_iou(other.box_px, detection.box_px) > settings.max_overlap;
    };
    if (std::none_of(kept.begin(), kept.end(), overlaps)) kept.push_back(std::move(detection));
  }
  return kept;
}

}  // namespace houghstream
