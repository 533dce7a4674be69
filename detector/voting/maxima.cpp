#include "detector/voting/maxima.hpp"

#include <algorithm>

#include "pipeline/base/weighted_median.hpp"

namespace houghstream {
namespace {

/// Returns whether a cell is a local maximum. Of equal neighbours the first one in reading order is.
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

/// Lists the local maxima of the Hough image, strongest first.
void list_maxima(const HoughSpace& space, float min_relative_peak, int limit, std::vector<HoughCell>& maxima) {
  const float largest = *std::max_element(space.image.begin(), space.image.end());
  const float minimum = std::max(1e-4F, min_relative_peak * largest);
  maxima.clear();
  for (int y = 0; y < space.height; ++y) {
    const float* row = space.image.data() + static_cast<std::ptrdiff_t>(y) * space.width;
    for (int x = 0; x < space.width; ++x) {
      if (row[x] > minimum && is_maximum(space, x, y)) maxima.push_back({x, y, row[x]});
    }
  }
  std::stable_sort(maxima.begin(), maxima.end(),
                   [](const HoughCell& a, const HoughCell& b) { return a.value > b.value; });
  if (maxima.size() > static_cast<std::size_t>(limit)) maxima.resize(static_cast<std::size_t>(limit));
}

/// Returns the weighted median depth of the votes of a cell's neighbourhood: the start of the mean shift.
float start_depth(const HoughSpace& space, const HoughCell& cell, MaximaWorkspace& workspace) {
  ranges_of_cells(space, cell.x, cell.y, 1, workspace.ranges);
  workspace.depths.clear();
  for (const VoteRange& range : workspace.ranges) {
    for (std::uint32_t v = range.begin; v < range.end; ++v) {
      workspace.depths.emplace_back(space.votes[v].centre_camera.z(), space.votes[v].weight);
    }
  }
  return weighted_median(workspace.depths);
}

}  // namespace

int per_class_budget(std::size_t classes, int per_class) {
  constexpr int kFewClasses = 4;
  constexpr int kMin = 6;
  const int shared = per_class * kFewClasses / std::max(static_cast<int>(classes), kFewClasses);
  return std::max(shared, std::min(per_class, kMin));
}

std::vector<Eigen::Vector3f> find_maxima(const HoughSpace& space, const Camera& camera, const VotingSettings& settings,
                                         int limit, MaximaWorkspace& workspace) {
  list_maxima(space, settings.min_relative_peak, limit, workspace.cells);
  std::vector<Eigen::Vector3f> centres;
  centres.reserve(workspace.cells.size());
  for (const HoughCell& cell : workspace.cells) {
    const float z = start_depth(space, cell, workspace);
    if (z <= 0.0F) continue;
    const double u = (cell.x + 0.5) * space.cell_px - 0.5;
    const double v = (cell.y + 0.5) * space.cell_px - 0.5;
    const Eigen::Vector3f start = camera.backproject(u, v, z).cast<float>();
    const Eigen::Vector3f centre = seek_mode(space, camera, start, settings.vote_sigma, workspace.ranges);
    const auto is_same = [&](const Eigen::Vector3f& other) {
      return (other - centre).norm() < 2.0F * settings.vote_sigma;
    };
    if (std::none_of(centres.begin(), centres.end(), is_same)) centres.push_back(centre);
  }
  return centres;
}

}  // namespace houghstream
