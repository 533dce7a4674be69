#include "detector/features/hole_filling.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <cstdint>
#include <limits>
#include <vector>

#include "pipeline/base/no_value.hpp"

namespace houghstream {
namespace {

constexpr int kBorder = 2;  // pixels around the distances, so that no neighbour needs a check
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Lengths of the steps, 1/65536 pixel.
constexpr int kStraight = 65536;
constexpr int kDiagonal = 91750;
constexpr int kKnight = 143976;  // one step straight and one diagonal
constexpr int kFarAway = INT_MAX - kKnight;

/// A neighbour that a distance may come from.
struct Step {
  int dx = 0;
  int dy = 0;
  int length = 0;
};

/// Neighbours above and to the left; the others are opposite.
constexpr std::array<Step, 8> kSteps = {{{-1, -2, kKnight},
                                         {1, -2, kKnight},
                                         {-2, -1, kKnight},
                                         {-1, -1, kDiagonal},
                                         {0, -1, kStraight},
                                         {1, -1, kDiagonal},
                                         {2, -1, kKnight},
                                         {-1, 0, kStraight}}};

void list_holes(const cv::Mat& depth, std::vector<Hole>& holes) {
  holes.clear();
  for (int y = 0; y < depth.rows; ++y) {
    const auto* row = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (row[x] != row[x]) holes.push_back({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)});
    }
  }
}

class Distances {
 public:
  Distances(cv::Size size, std::vector<std::int32_t>& workspace)
      : stride_(size.width + 2 * kBorder), memory_(workspace) {
    memory_.assign(static_cast<std::size_t>(stride_ * (size.height + 2 * kBorder)), kFarAway);
    for (int y = 0; y < size.height; ++y) std::fill_n(&at({0, static_cast<std::int16_t>(y)}), size.width, 0);
  }

  std::int32_t& at(Hole hole) {
    return memory_[static_cast<std::size_t>((hole.y + kBorder) * stride_ + hole.x + kBorder)];
  }

  /// Takes the depth of the neighbour whose source is nearest; `side` is 1, or -1 for those opposite.
  template <bool kInMetres>
  void borrow(Hole hole, int side, cv::Mat& depth) {
    std::int32_t& distance_here = at(hole);
    float& depth_here = depth.ptr<float>(hole.y)[hole.x];
    const std::int32_t* distances = &distance_here;
    float nearest = distance_here == kFarAway ? kInfinity : nearness<kInMetres>(distance_here, depth_here);
    for (const Step& step : kSteps) {
      const std::int32_t distance = distances[side * (step.dy * stride_ + step.dx)] + step.length;
      if (distance >= kFarAway) continue;  // no lender there, or outside of the image
      const float lent = depth.ptr<float>(hole.y + side * step.dy)[hole.x + side * step.dx];
      const float candidate = nearness<kInMetres>(distance, lent);
      if (candidate >= nearest) continue;
      nearest = candidate;
      distance_here = distance;
      depth_here = lent;
    }
  }

 private:
  template <bool kInMetres>
  static float nearness(std::int32_t distance, float lent) {
    return static_cast<float>(distance) * (kInMetres ? lent : 1.0F);
  }

  int stride_ = 0;
  std::vector<std::int32_t>& memory_;
};

template <bool kInMetres>
void borrow_all(const std::vector<Hole>& holes, Distances& distances, cv::Mat& depth) {
  for (const Hole hole : holes) distances.borrow<kInMetres>(hole, 1, depth);
  for (auto hole = holes.rbegin(); hole != holes.rend(); ++hole) distances.borrow<kInMetres>(*hole, -1, depth);
}

}  // namespace

void fill_holes(cv::Mat& depth, const HoleReach& reach, HoleWorkspace& workspace) {
  const std::vector<Hole>& holes = workspace.holes;
  list_holes(depth, workspace.holes);
  if (holes.empty() || holes.size() == depth.total()) return;
  Distances distances(depth.size(), workspace.distances);
  for (const Hole hole : holes) distances.at(hole) = kFarAway;
  if (reach.px_at_1m > 0.0F) {
    borrow_all<true>(holes, distances, depth);
  } else {
    borrow_all<false>(holes, distances, depth);
  }
  for (const Hole hole : holes) {
    float& lent = depth.ptr<float>(hole.y)[hole.x];
    const float farthest = std::max(reach.px, reach.px_at_1m / lent) * kStraight;
    if (static_cast<float>(distances.at(hole)) > farthest) lent = kNoValue;
  }
}

}  // namespace houghstream
