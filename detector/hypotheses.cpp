#include "detector/hypotheses.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace houghstream {
namespace {

struct Cell {
  int x = 0;
  int y = 0;
  float value = 0.0F;
};

/// Local maxima of the Hough image, strongest first; of equal neighbours the first in reading order counts.
std::vector<Cell> image_maxima(const HoughSpace& space, const DetectionSettings& settings) {
  const float largest = *std::max_element(space.image.begin(), space.image.end());
  const float least = std::max(1e-4F, settings.min_relative_peak * largest);
  std::vector<Cell> maxima;
  for (int y = 0; y < space.height; ++y) {
    for (int x = 0; x < space.width; ++x) {
      const int here = y * space.width + x;
      const float value = space.image[static_cast<std::size_t>(here)];
      bool is_maximum = value > least;
      for (int dy = -1; dy <= 1 && is_maximum; ++dy) {
        for (int dx = -1; dx <= 1 && is_maximum; ++dx) {
          const bool inside = x + dx >= 0 && x + dx < space.width && y + dy >= 0 && y + dy < space.height;
          if (!inside || (dx == 0 && dy == 0)) continue;
          const int there = here + dy * space.width + dx;
          const float other = space.image[static_cast<std::size_t>(there)];
          is_maximum = there < here ? value > other : value >= other;
        }
      }
      if (is_maximum) maxima.push_back({x, y, value});
    }
  }
  std::stable_sort(maxima.begin(), maxima.end(), [](const Cell& a, const Cell& b) { return a.value > b.value; });
  const auto limit = static_cast<std::size_t>(settings.candidates_per_class);
  if (maxima.size() > limit) maxima.resize(limit);
  return maxima;
}

/// Calls visit(vote) for the votes seen within `radius_cells` of a cell.
template <typename Visit>
void for_votes_near(const HoughSpace& space, int cell_x, int cell_y, int radius_cells, const Visit& visit) {
  const int x0 = std::max(0, cell_x - radius_cells);
  const int x1 = std::min(space.width - 1, cell_x + radius_cells);
  for (int y = std::max(0, cell_y - radius_cells); y <= std::min(space.height - 1, cell_y + radius_cells); ++y) {
    const std::uint32_t begin = space.first_vote[static_cast<std::size_t>(y * space.width + x0)];
    const std::uint32_t end = space.first_vote[static_cast<std::size_t>(y * space.width + x1) + 1];
    for (std::uint32_t v = begin; v < end; ++v) visit(space.votes[v]);
  }
}

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

/// Weighted median depth of the votes of a cell's neighbourhood: the start of the mean shift.
float start_depth(const HoughSpace& space, const Cell& cell) {
  std::vector<std::pair<float, float>> depths;
  float total = 0.0F;
  for_votes_near(space, cell.x, cell.y, 1, [&](const Vote& vote) {
    depths.emplace_back(vote.centre_camera.z(), vote.weight);
    total += vote.weight;
  });
  return weighted_median(depths, total);
}

class MaximumSearch {
 public:
  MaximumSearch(const HoughSpace& space, const Camera& camera, const DetectionSettings& settings)
      : space_(space), camera_(camera), sigma_(settings.vote_sigma) {}

  template <typename Visit>
  void for_votes_around(const Eigen::Vector3f& centre, const Visit& visit) const {
    const Eigen::Vector2d px = camera_.project(centre.cast<double>());
    const int x = static_cast<int>(std::floor((px.x() + 0.5) / space_.cell_px));
    const int y = static_cast<int>(std::floor((px.y() + 0.5) / space_.cell_px));
    const double reach_px = kVoteReach * sigma_ / camera_.metres_per_px(centre.z());
    const int radius = static_cast<int>(reach_px / space_.cell_px) + 1;
    for_votes_near(space_, x, y, radius, [&](const Vote& vote) {
      const float k = vote_kernel((vote.centre_camera - centre).squaredNorm(), sigma_);
      if (k > 0.0F) visit(vote, k);
    });
  }

  Eigen::Vector3f climb(Eigen::Vector3f centre) const {
    constexpr int kSteps = 8;
    for (int step = 0; step < kSteps; ++step) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      float total = 0.0F;
      for_votes_around(centre, [&](const Vote& vote, float k) {
        sum += k * vote.weight * vote.centre_camera;
        total += k * vote.weight;
      });
      if (total <= 0.0F) break;
      const Eigen::Vector3f next = sum / total;
      const bool arrived = (next - centre).norm() < 0.0005F;
      centre = next;
      if (arrived) break;
    }
    return centre;
  }

 private:
  const HoughSpace& space_;
  const Camera& camera_;
  float sigma_;
};

/// Pairs of index and sum of those sums that are not 0, in order of the index.
std::vector<std::pair<std::uint32_t, float>> nonzero(const std::vector<float>& sums) {
  std::vector<std::pair<std::uint32_t, float>> out;
  for (std::uint32_t i = 0; i < sums.size(); ++i) {
    if (sums[i] > 0.0F) out.emplace_back(i, sums[i]);
  }
  return out;
}

/// What is seen of the object: weight of the supporting votes times the area of their patches.
float support_mass(const MaximumSearch& search, const Eigen::Vector3f& centre, const PatchGrid& patches) {
  float mass = 0.0F;
  search.for_votes_around(centre,
                          [&](const Vote& vote, float k) { mass += k * vote.weight * patches.area[vote.patch]; });
  return mass;
}

/// Everything that supports a maximum.
Hypothesis gather_support(const Forest& forest, const MaximumSearch& search, const Eigen::Vector3f& centre, float mass,
                          std::size_t patch_count) {
  Hypothesis hypothesis;
  hypothesis.centre_camera = centre;
  hypothesis.mass = mass;
  std::vector<float> by_patch(patch_count, 0.0F);
  std::vector<float> by_view(forest.views.size(), 0.0F);
  search.for_votes_around(centre, [&](const Vote& vote, float k) {
    const float weight = k * vote.weight;
    hypothesis.weight += weight;
    ++hypothesis.vote_count;
    by_patch[vote.patch] += weight;
    const LeafClass& entry = forest.leaf_classes[vote.leaf_class];
    for (std::uint32_t v = entry.first_view; v < entry.first_view + entry.view_count; ++v) {
      by_view[forest.leaf_views[v].view] += weight * forest.leaf_views[v].weight;
    }
  });
  hypothesis.patches = nonzero(by_patch);
  hypothesis.views = nonzero(by_view);
  std::stable_sort(hypothesis.views.begin(), hypothesis.views.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
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
    std::sort(values[i].begin(), values[i].end());
    const std::size_t outliers = values[i].size() / 50;
    sides[i] = i < 2 ? values[i][outliers] : values[i][values[i].size() - 1 - outliers];
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

std::vector<Hypothesis> find_maxima(const Forest& forest, const HoughSpace& space, const PatchGrid& patches,
                                    const Camera& working_camera, float least_mass, const DetectionSettings& settings) {
  const MaximumSearch search(space, working_camera, settings);
  std::vector<Eigen::Vector3f> centres;
  for (const Cell& cell : image_maxima(space, settings)) {
    const float z = start_depth(space, cell);
    if (z <= 0.0F) continue;
    const double u = (cell.x + 0.5) * space.cell_px - 0.5;
    const double v = (cell.y + 0.5) * space.cell_px - 0.5;
    const Eigen::Vector3f centre = search.climb(working_camera.backproject(u, v, z).cast<float>());
    const auto meets = [&](const Eigen::Vector3f& other) {
      return (other - centre).norm() < 2.0F * settings.vote_sigma;
    };
    if (std::none_of(centres.begin(), centres.end(), meets)) centres.push_back(centre);
  }
  std::vector<Hypothesis> hypotheses;
  for (const Eigen::Vector3f& centre : centres) {
    const float mass = support_mass(search, centre, patches);
    if (mass < least_mass) continue;
    hypotheses.push_back(gather_support(forest, search, centre, mass, patches.size()));
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
