#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "detector/training/pictures/camera_variation.hpp"
#include "detector/training/pictures/composites.hpp"

namespace houghstream::training {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kFar = 1e6F;        // stands for none where the nearest is sought
constexpr double kEdgeStep = 0.03;  // a depth edge, relative to depth

/// Nearly normal, deviation 1: the sum of four uniforms of 16 bits.
float quick_normal(Random& random) {
  const std::uint64_t bits = random.bits();
  const auto sum =
      static_cast<float>((bits & 0xffffU) + ((bits >> 16U) & 0xffffU) + ((bits >> 32U) & 0xffffU) + (bits >> 48U));
  return (sum - 131070.0F) * (1.0F / 37837.2F);  // its mean; its deviation, 65536 / sqrt(3)
}

/// Noise that neighbours share, deviation 1: cameras match windows, not pixels.
cv::Mat window_noise(cv::Size size, Random& random) {
  cv::Mat noise(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y) {
    auto* row = noise.ptr<float>(y);
    for (int x = 0; x < size.width; ++x) row[x] = 3.0F * quick_normal(random);  // a mean of nine has a third of it
  }
  cv::boxFilter(noise, noise, CV_32F, {3, 3});
  return noise;
}

/// Where depth is known: CV_8UC1.
cv::Mat known(const cv::Mat& depth) {
  return depth == depth;
}

/// The nearest and the farthest known depth within so many pixels; nothing is kFar or 0.
struct Range {
  cv::Mat nearest;
  cv::Mat farthest;
};

Range around(const cv::Mat& depth, cv::Size reach_px) {
  const cv::Mat window = cv::getStructuringElement(cv::MORPH_RECT, {2 * reach_px.width + 1, 2 * reach_px.height + 1});
  Range range;
  cv::Mat filled = depth.clone();
  cv::patchNaNs(filled, kFar);
  cv::erode(filled, range.nearest, window);
  filled.setTo(0.0F, filled == kFar);
  cv::dilate(filled, range.farthest, window);
  return range;
}

cv::Mat edges_of(const Range& range) {
  return range.farthest > (1.0 + kEdgeStep) * range.nearest;
}

void shift(const std::array<int, 2>& by_px, cv::Mat& depth) {
  if (by_px[0] == 0 && by_px[1] == 0) return;
  const int most_px = std::max(std::abs(by_px[0]), std::abs(by_px[1]));
  cv::Mat padded;
  cv::copyMakeBorder(depth, padded, most_px, most_px, most_px, most_px, cv::BORDER_REPLICATE);
  padded(cv::Rect({most_px - by_px[0], most_px - by_px[1]}, depth.size())).copyTo(depth);
}

void grow(const std::array<int, 2>& by_px, cv::Mat& depth) {
  if (by_px[0] == 0 && by_px[1] == 0) return;
  const cv::Mat holes = ~known(depth);
  depth = around(depth, {by_px[0], by_px[1]}).nearest;
  depth.setTo(kNone, holes);
}

/// Outlines that waver, and pixels that see both surfaces of an edge.
void blur_edges(const DepthVariation& camera, cv::Mat& depth, Random& random) {
  if (camera.jitter_px <= 0.0 && camera.flying_share <= 0.0) return;
  const Range near_range = around(depth, {1, 1});
  const cv::Mat edges = edges_of(near_range);
  const cv::Mat before = depth.clone();
  const int reach_px = static_cast<int>(std::ceil(2.0 * camera.jitter_px));
  cv::Mat wavering = edges;
  if (reach_px > 1) cv::dilate(edges, wavering, cv::Mat::ones(2 * reach_px - 1, 2 * reach_px - 1, CV_8UC1));
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      float& z = depth.at<float>(y, x);
      if (wavering.at<std::uint8_t>(y, x) == 0 || std::isnan(z)) continue;
      const auto right = static_cast<int>(std::lround(camera.jitter_px * quick_normal(random)));
      const auto down = static_cast<int>(std::lround(camera.jitter_px * quick_normal(random)));
      const int from_x = std::clamp(x + std::clamp(right, -reach_px, reach_px), 0, depth.cols - 1);
      const int from_y = std::clamp(y + std::clamp(down, -reach_px, reach_px), 0, depth.rows - 1);
      const float other = before.at<float>(from_y, from_x);
      if (!std::isnan(other)) z = other;
      if (edges.at<std::uint8_t>(y, x) == 0 || random.uniform() >= camera.flying_share) continue;
      const auto share = static_cast<float>(random.uniform());
      const float nearest = near_range.nearest.at<float>(y, x);
      z = nearest + share * (near_range.farthest.at<float>(y, x) - nearest);
    }
  }
}

/// How much light comes back and how slanting a surface is; what the noise and the holes go by.
class Surfaces {
 public:
  Surfaces(const cv::Mat& depth, const cv::Mat& colour, const Camera& view)
      : depth_(depth.clone()), focal_px_(static_cast<float>(view.fx)) {
    if (colour.empty()) return;
    cv::cvtColor(colour, grey_, cv::COLOR_BGR2GRAY);
  }

  /// Tangent of the incidence; 0 where it is not known. Over some pixels: recorded depth is noisy.
  float slant(int x, int y) const {
    constexpr int kReach = 2;
    const float z = depth_.at<float>(y, x);
    const int left = std::max(0, x - kReach);
    const int right = std::min(depth_.cols - 1, x + kReach);
    const int up = std::max(0, y - kReach);
    const int down = std::min(depth_.rows - 1, y + kReach);
    const float across = (depth_.at<float>(y, right) - depth_.at<float>(y, left)) / static_cast<float>(right - left);
    const float along = (depth_.at<float>(down, x) - depth_.at<float>(up, x)) / static_cast<float>(down - up);
    const float slant = std::sqrt(across * across + along * along) * focal_px_ / z;
    return std::isnan(slant) ? 0.0F : slant;
  }

  float reflectance(int x, int y) const {
    if (grey_.empty()) return 0.3F;
    const float value = static_cast<float>(grey_.at<std::uint8_t>(y, x)) * (1.0F / 255.0F);
    return std::max(0.01F, value * value);  // about that of linear light
  }

 private:
  cv::Mat depth_;
  cv::Mat grey_;
  float focal_px_;
};

void add_structured_noise(const DepthVariation& camera, const Surfaces& surfaces, cv::Mat& depth, Random& random) {
  constexpr float kMostSlant = 4.0F;  // Nguyen et al.'s term grows without bound
  if (camera.noise > 0.0) {
    const cv::Mat noise = window_noise(depth.size(), random);
    const auto gain = static_cast<float>(camera.noise);
    for (int y = 0; y < depth.rows; ++y) {
      for (int x = 0; x < depth.cols; ++x) {
        float& z = depth.at<float>(y, x);
        if (std::isnan(z)) continue;
        float sigma = static_cast<float>(axial_noise(z));
        const float slant = std::min(kMostSlant, surfaces.slant(x, y));
        if (slant > 1.73F) {  // 60 degrees
          const float angle = std::atan(slant);
          const float ratio = angle / (static_cast<float>(M_PI_2) - angle);
          sigma += 0.0001F / std::sqrt(z) * ratio * ratio;
        }
        z += gain * sigma * noise.at<float>(y, x);
      }
    }
  }
  if (camera.disparity_step_px <= 0.0) return;
  const auto scale = static_cast<float>(580.0 * 0.075 / camera.disparity_step_px);
  for (int y = 0; y < depth.rows; ++y) {
    auto* row = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (row[x] > 0.0F) row[x] = scale / std::max(1.0F, std::floor(scale / row[x] + 0.5F));
    }
  }
}

void add_time_of_flight_noise(const DepthVariation& camera, const Surfaces& surfaces, cv::Mat& depth, Random& random) {
  const auto floor_sq = static_cast<float>(camera.noise_floor * camera.noise_floor);
  const auto light_sq = static_cast<float>(camera.noise_light * camera.noise_light);
  const auto wiggle = static_cast<float>(camera.wiggle);
  const auto turns = static_cast<float>(2.0 * M_PI / camera.wiggle_wave);
  const auto phase = static_cast<float>(camera.wiggle_phase);
  const auto dark_bias = static_cast<float>(camera.dark_bias);
  constexpr float kMostSigma = 0.03F;  // more is not reported
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      float& z = depth.at<float>(y, x);
      if (std::isnan(z)) continue;
      const float reflectance = surfaces.reflectance(x, y);
      const float slant = surfaces.slant(x, y);
      const float amplitude_sq = reflectance * reflectance / ((1.0F + slant * slant) * z * z * z * z);
      const float sigma = std::min(kMostSigma, std::sqrt(floor_sq + light_sq / amplitude_sq));
      const float dark = std::max(0.0F, 1.0F - reflectance / 0.3F);
      z += wiggle * std::sin(turns * z + phase) + dark_bias * dark + sigma * quick_normal(random);
    }
  }
}

void smooth(const DepthVariation& camera, cv::Mat& depth) {
  if (camera.smoothing == DepthSmoothing::kNone) return;
  constexpr double kSameSurface = 0.02;  // metres
  const cv::Mat there = known(depth);
  cv::Mat filled = depth.clone();
  cv::patchNaNs(filled, 0.0);
  cv::Mat smoothed;
  if (camera.smoothing == DepthSmoothing::kMedian) {
    cv::medianBlur(filled, smoothed, camera.smoothing_px);
  } else {
    cv::bilateralFilter(filled, smoothed, camera.smoothing_px, kSameSurface, camera.smoothing_px);
  }
  smoothed.copyTo(depth, there & (smoothed > 0.0F));  // among holes it stays as it was
}

/// Pixels that the projector does not reach, because something nearer hides them from it.
void cast_shadow(double baseline_m, double focal_px, cv::Mat& depth) {
  if (baseline_m == 0.0) return;
  const bool right = baseline_m > 0.0;
  const auto shift_px = static_cast<float>(focal_px * std::abs(baseline_m));
  for (int y = 0; y < depth.rows; ++y) {
    auto* row = depth.ptr<float>(y);
    // Towards the projector's far side the columns at which it sees points grow, but for what something nearer hides.
    float most = -std::numeric_limits<float>::infinity();
    for (int i = 0; i < depth.cols; ++i) {
      float& z = row[right ? depth.cols - 1 - i : i];
      if (std::isnan(z)) continue;
      const float column = static_cast<float>(i) + shift_px / z;
      if (column < most - 1.5F) z = kNone;
      most = std::max(most, column);
    }
  }
}

void make_holes(const DepthVariation& camera, const Surfaces& surfaces, cv::Mat& depth, Random& random) {
  if (camera.edge_loss <= 0.0 && camera.least_cosine <= 0.0 && camera.least_signal <= 0.0) return;
  const cv::Mat edges = edges_of(around(depth, {1, 1}));
  cv::Mat near_edges;
  cv::dilate(edges, near_edges, cv::Mat::ones(3, 3, CV_8UC1));  // where slant() looks across the edge
  const cv::Mat noise = window_noise(depth.size(), random);
  const auto edge_loss = static_cast<float>(camera.edge_loss);
  const auto least_cosine = static_cast<float>(camera.least_cosine);
  const auto least_signal = static_cast<float>(camera.least_signal);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      float& z = depth.at<float>(y, x);
      if (std::isnan(z)) continue;
      const float level = noise.at<float>(y, x);
      if (edges.at<std::uint8_t>(y, x) != 0) {
        const float rank = 1.0F / (1.0F + std::exp(1.702F * level));  // the normal distribution's, nearly
        if (rank < edge_loss) z = kNone;
        continue;
      }
      if (near_edges.at<std::uint8_t>(y, x) != 0) continue;
      const float slant = surfaces.slant(x, y);
      const float cosine = 1.0F / std::sqrt(1.0F + slant * slant);
      const float wobble = std::max(0.2F, 1.0F + 0.25F * level);
      const bool dark = surfaces.reflectance(x, y) * cosine < least_signal * wobble * z * z;
      if (cosine < least_cosine * wobble || dark) z = kNone;
    }
  }
}

}  // namespace

void apply_depth(const CameraVariation& camera, const Camera& view, cv::Mat& depth, Random& random,
                 const cv::Mat& colour) {
  const DepthVariation& made = camera.depth;
  const Surfaces surfaces(depth, colour, view);
  grow(made.grown_px, depth);
  blur_edges(made, depth, random);
  if (made.kind == DepthKind::kStructuredLight) {
    cast_shadow(made.shadow_m, view.fx, depth);
    add_structured_noise(made, surfaces, depth, random);
  } else {
    add_time_of_flight_noise(made, surfaces, depth, random);
  }
  smooth(made, depth);
  make_holes(made, surfaces, depth, random);
  if (made.scale != 1.0) depth *= made.scale;
  shift(made.offset_px, depth);
}

}  // namespace houghstream::training
