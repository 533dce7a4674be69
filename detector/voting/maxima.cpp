#include "detector/voting/maxima.hpp"

#include <algorithm>
#include <utility>

#include "detector/voting/mean_shift.hpp"
#include "detector/voting/weighted_median.hpp"

namespace houghstream {
namespace {

struct Cell {
  int x = 0;
  int y = 0;
  float value = 0.0F;
};

/// Of equal neighbours the first in reading order counts.
bool is_maximum(const HoughSpace& space, int x, int y) {
  const int here = y * space.width + x;
  const float value = space.image[static_cast<std::size_t>(here)];
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const bool inside = x + dx >= 0 && x + dx < space.width && y + dy >= 0 && y + dy < space.height;
      if (!inside || (dx == 0 && dy == 0)) continue;
      const int there = here + dy * space.width + dx;
      const float other = space.image[static_cast<std::size_t>(there)];
      if (there < here ? value <= other : value < other) return false;
    }
  }
  return true;
}

/// Local maxima of the Hough image, strongest first; valid until the thread's next call.
const std::vector<Cell>& image_maxima(const HoughSpace& space, const DetectionSettings& settings) {
  const float largest = *std::max_element(space.image.begin(), space.image.end());
  const float least = std::max(1e-4F, settings.min_relative_peak * largest);
  static thread_local std::vector<Cell> maxima;  // kept from class to class
  maxima.clear();
  for (int y = 0; y < space.height; ++y) {
    const float* row = space.image.data() + static_cast<std::ptrdiff_t>(y) * space.width;
    for (int x = 0; x < space.width; ++x) {
      if (row[x] > least && is_maximum(space, x, y)) maxima.push_back({x, y, row[x]});
    }
  }
  std::stable_sort(maxima.begin(), maxima.end(), [](const Cell& a, const Cell& b) { return a.value > b.value; });
  const auto limit = static_cast<std::size_t>(settings.candidates_per_class);
  if (maxima.size() > limit) maxima.resize(limit);
  return maxima;
}

/// Weighted median depth of the votes of a cell's neighbourhood: the start of the mean shift.
float start_depth(const HoughSpace& space, const Cell& cell) {
  static thread_local std::vector<VoteRange> ranges;  // both kept from cell to cell
  static thread_local std::vector<std::pair<float, float>> depths;
  ranges_near(space, cell.x, cell.y, 1, ranges);
  depths.clear();
  for (const VoteRange& range : ranges) {
    for (std::uint32_t v = range.begin; v < range.end; ++v) {
      depths.emplace_back(space.votes[v].centre_camera.z(), space.votes[v].weight);
    }
  }
  return weighted_median(depths);
}

}  // namespace

int candidates_of_each(const DetectionSettings& settings, std::size_t classes) {
  constexpr int kFewClasses = 4;
  constexpr int kLeast = 6;
  const int shared = settings.candidates_per_class * kFewClasses / std::max(static_cast<int>(classes), kFewClasses);
  return std::max(shared, std::min(settings.candidates_per_class, kLeast));
}

std::vector<Eigen::Vector3f> find_maxima(const HoughSpace& space, const Camera& working_camera,
                                         const DetectionSettings& settings) {
  const std::vector<Cell>& cells = image_maxima(space, settings);
  std::vector<Eigen::Vector3f> centres;
  centres.reserve(cells.size());
  for (const Cell& cell : cells) {
    const float z = start_depth(space, cell);
    if (z <= 0.0F) continue;
    const double u = (cell.x + 0.5) * space.cell_px - 0.5;
    const double v = (cell.y + 0.5) * space.cell_px - 0.5;
    const Eigen::Vector3f start = working_camera.backproject(u, v, z).cast<float>();
    const Eigen::Vector3f centre = climb(space, working_camera, start, settings.vote_sigma);
    const auto meets = [&](const Eigen::Vector3f& other) {
      return (other - centre).norm() < 2.0F * settings.vote_sigma;
    };
    if (std::none_of(centres.begin(), centres.end(), meets)) centres.push_back(centre);
  }
  return centres;
}

}  // namespace houghstream
