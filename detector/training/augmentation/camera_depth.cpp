#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "detector/training/augmentation/camera_randomisation.hpp"
#include "detector/training/augmentation/composites.hpp"
#include "pipeline/base/no_value.hpp"

namespace houghstream::training {
namespace {

constexpr float kFar = 1e6F;        // stands for none where the nearest is sought
constexpr double kEdgeStep = 0.03;  // a depth edge, relative to depth

/// Draws a nearly normal number, deviation 1: the sum of four uniforms of 16 bits.
float quick_normal(Random& random) {
  const std::uint64_t bits = random.bits();
  const auto sum =
      static_cast<float>((bits & 0xffffU) + ((bits >> 16U) & 0xffffU) + ((bits >> 32U) & 0xffffU) + (bits >> 48U));
  return (sum - 131070.0F) * (1.0F / 37837.2F);  // its mean; its deviation, 65536 / sqrt(3)
}

/// Makes noise that neighbours share, deviation 1: cameras match windows, not pixels.
cv::Mat window_noise(cv::Size size, Random& random) {
  cv::Mat noise(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y) {
    auto* row = noise.ptr<float>(y);
    for (int x = 0; x < size.width; ++x) row[x] = 3.0F * quick_normal(random);  // a mean of nine has a third of it
  }
  cv::boxFilter(noise, noise, CV_32F, {3, 3});
  return noise;
}

/// Returns the mask of known depth: CV_8UC1.
cv::Mat known(const cv::Mat& depth) {
  return depth == depth;
}

/// Returns the nearest known depth within so many pixels; kFar where there is none.
cv::Mat nearest_around(const cv::Mat& depth, int right_px, int down_px) {
  cv::Mat nearest = depth.clone();
  cv::patchNaNs(nearest, kFar);
  cv::erode(nearest, nearest, cv::getStructuringElement(cv::MORPH_RECT, {2 * right_px + 1, 2 * down_px + 1}));
  return nearest;
}

cv::Mat max_around(const cv::Mat& depth) {
  cv::Mat farthest = depth.clone();
  cv::patchNaNs(farthest, 0.0);
  cv::dilate(farthest, farthest, cv::Mat());  // 3x3
  return farthest;
}

/// Pixels where a surface ends before another one, with the depths of both.
struct Edges {
  cv::Mat nearest;   ///< CV_32FC1
  cv::Mat farthest;  ///< CV_32FC1
  cv::Mat mask;      ///< CV_8UC1
};

Edges find_edges(const cv::Mat& depth) {
  Edges edges;
  edges.nearest = nearest_around(depth, 1, 1);
  edges.farthest = max_around(depth);
  edges.mask = edges.farthest > (1.0 + kEdgeStep) * edges.nearest;
  return edges;
}

void shift(const std::array<int, 2>& by_px, cv::Mat& depth) {
  if (by_px[0] == 0 && by_px[1] == 0) return;
  const int max_px = std::max(std::abs(by_px[0]), std::abs(by_px[1]));
  cv::Mat padded;
  cv::copyMakeBorder(depth, padded, max_px, max_px, max_px, max_px, cv::BORDER_REPLICATE);
  padded(cv::Rect({max_px - by_px[0], max_px - by_px[1]}, depth.size())).copyTo(depth);
}

void grow(const std::array<int, 2>& by_px, cv::Mat& depth) {
  if (by_px[0] == 0 && by_px[1] == 0) return;
  const cv::Mat holes = ~known(depth);
  depth = nearest_around(depth, by_px[0], by_px[1]);
  depth.setTo(kNoValue, holes);
}

/// Outlines that waver, and pixels that see both surfaces of an edge.
void blur_edges(const DepthVariation& camera, const Edges& edges, cv::Mat& depth, Random& random) {
  if (camera.jitter_px <= 0.0 && camera.flying_pixel_fraction <= 0.0) return;
  const cv::Mat before = depth.clone();
  const int reach_px = static_cast<int>(std::ceil(2.0 * camera.jitter_px));
  cv::Mat wavering = edges.mask;
  if (reach_px > 1) cv::dilate(edges.mask, wavering, cv::Mat::ones(2 * reach_px - 1, 2 * reach_px - 1, CV_8UC1));
  for (int y = 0; y < depth.rows; ++y) {
    auto* row = depth.ptr<float>(y);
    const auto* wavers = wavering.ptr<std::uint8_t>(y);
    const auto* is_edge = edges.mask.ptr<std::uint8_t>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (wavers[x] == 0 || std::isnan(row[x])) continue;
      const auto right = static_cast<int>(std::lround(camera.jitter_px * quick_normal(random)));
      const auto down = static_cast<int>(std::lround(camera.jitter_px * quick_normal(random)));
      const int from_x = std::clamp(x + std::clamp(right, -reach_px, reach_px), 0, depth.cols - 1);
      const int from_y = std::clamp(y + std::clamp(down, -reach_px, reach_px), 0, depth.rows - 1);
      const float other = before.at<float>(from_y, from_x);
      if (!std::isnan(other)) row[x] = other;
      if (is_edge[x] == 0 || random.uniform() >= camera.flying_pixel_fraction) continue;
      const auto fraction = static_cast<float>(random.uniform());
      const float nearest = edges.nearest.at<float>(y, x);
      row[x] = nearest + fraction * (edges.farthest.at<float>(y, x) - nearest);
    }
  }
}

/// Inputs of the noise and of the holes.
struct Surfaces {
  cv::Mat slant_sq;     ///< CV_32FC1: tangent of the incidence, squared; 0 where it is not known
  cv::Mat reflectance;  ///< CV_32FC1: about that of linear light
};

/// Computes slants from depth as it was given, over some pixels: recorded depth is noisy.
cv::Mat slants(const cv::Mat& depth, double focal_px) {
  constexpr int kReach = 2;
  cv::Mat out(depth.size(), CV_32FC1, cv::Scalar(0));
  const auto focal = static_cast<float>(focal_px / (2 * kReach));
  for (int y = kReach; y < depth.rows - kReach; ++y) {
    const auto* up = depth.ptr<float>(y - kReach);
    const auto* row = depth.ptr<float>(y);
    const auto* down = depth.ptr<float>(y + kReach);
    auto* out_row = out.ptr<float>(y);
    for (int x = kReach; x < depth.cols - kReach; ++x) {
      const float across = row[x + kReach] - row[x - kReach];
      const float along = down[x] - up[x];
      const float scale = focal / row[x];
      const float slant_sq = (across * across + along * along) * scale * scale;
      out_row[x] = slant_sq >= 0.0F ? slant_sq : 0.0F;  // false for NaN
    }
  }
  return out;
}

Surfaces find_surfaces(const cv::Mat& depth, const cv::Mat& colour, double focal_px) {
  constexpr double kGrey = 0.3;
  constexpr double kBlack = 0.01;
  Surfaces surfaces;
  surfaces.slant_sq = slants(depth, focal_px);
  if (colour.empty()) {
    surfaces.reflectance = cv::Mat(depth.size(), CV_32FC1, cv::Scalar(kGrey));
  } else {
    cv::Mat grey;
    cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
    grey.convertTo(surfaces.reflectance, CV_32F, 1.0 / 255.0);
    surfaces.reflectance = cv::max(surfaces.reflectance.mul(surfaces.reflectance), kBlack);
  }
  return surfaces;
}

/// Returns the growth of the axial noise on surfaces seen at more than 60 degrees (Nguyen et al.).
float oblique_noise(float slant_sq, float z) {
  constexpr float kMaxSlant = 4.0F;  // the term grows without bound
  const float angle = std::atan(std::min(kMaxSlant, std::sqrt(slant_sq)));
  const float ratio = angle / (static_cast<float>(M_PI_2) - angle);
  return 0.0001F / std::sqrt(z) * ratio * ratio;
}

void add_structured_noise(const DepthVariation& camera, const Surfaces& surfaces, cv::Mat& depth, Random& random) {
  constexpr float kOblique = 3.0F;  // the tangent of 60 degrees, squared
  if (camera.noise <= 0.0) return;
  const cv::Mat noise = window_noise(depth.size(), random);
  const auto gain = static_cast<float>(camera.noise);
  for (int y = 0; y < depth.rows; ++y) {
    auto* row = depth.ptr<float>(y);
    const auto* noise_row = noise.ptr<float>(y);
    const auto* slant_sq = surfaces.slant_sq.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (std::isnan(row[x])) continue;
      auto sigma = static_cast<float>(axial_noise(row[x]));
      if (slant_sq[x] > kOblique) sigma += oblique_noise(slant_sq[x], row[x]);
      row[x] += gain * sigma * noise_row[x];
    }
  }
}

void quantise_disparity(double step_px, cv::Mat& depth) {
  if (step_px <= 0.0) return;
  const auto scale = static_cast<float>(580.0 * 0.075 / step_px);
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
  const auto rotations = static_cast<float>(2.0 * M_PI / camera.wiggle_wave);
  const auto phase = static_cast<float>(camera.wiggle_phase);
  const auto dark_bias = static_cast<float>(camera.dark_bias);
  constexpr float kMaxSigma = 0.03F;  // more is not reported
  constexpr float kGrey = 0.3F;       // grey from which on nothing is too dark
  for (int y = 0; y < depth.rows; ++y) {
    auto* row = depth.ptr<float>(y);
    const auto* slant_sq = surfaces.slant_sq.ptr<float>(y);
    const auto* reflectance = surfaces.reflectance.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      const float z = row[x];
      if (std::isnan(z)) continue;
      const float amplitude_sq = reflectance[x] * reflectance[x] / ((1.0F + slant_sq[x]) * z * z * z * z);
      const float sigma = std::min(kMaxSigma, std::sqrt(floor_sq + light_sq / amplitude_sq));
      const float dark = std::max(0.0F, 1.0F - reflectance[x] / kGrey);
      row[x] += wiggle * std::sin(rotations * z + phase) + dark_bias * dark + sigma * quick_normal(random);
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
    float maximum = -std::numeric_limits<float>::infinity();
    for (int i = 0; i < depth.cols; ++i) {
      float& z = row[right ? depth.cols - 1 - i : i];
      if (std::isnan(z)) continue;
      const float column = static_cast<float>(i) + shift_px / z;
      if (column < maximum - 1.5F) z = kNoValue;
      maximum = std::max(maximum, column);
    }
  }
}

void make_holes(const DepthVariation& camera, const Edges& edges, const Surfaces& surfaces, cv::Mat& depth,
                Random& random) {
  if (camera.edge_loss <= 0.0 && camera.min_cosine <= 0.0 && camera.min_signal <= 0.0) return;
  cv::Mat near_edges;
  cv::dilate(edges.mask, near_edges, cv::Mat());  // excludes slants across the edge
  const cv::Mat noise = window_noise(depth.size(), random);
  const auto edge_loss = static_cast<float>(camera.edge_loss);
  const auto cosine_sq = static_cast<float>(camera.min_cosine * camera.min_cosine);
  const auto signal_sq = static_cast<float>(camera.min_signal * camera.min_signal);
  for (int y = 0; y < depth.rows; ++y) {
    auto* row = depth.ptr<float>(y);
    const auto* noise_row = noise.ptr<float>(y);
    const auto* is_edge = edges.mask.ptr<std::uint8_t>(y);
    const auto* is_near_edge = near_edges.ptr<std::uint8_t>(y);
    const auto* slant_sq = surfaces.slant_sq.ptr<float>(y);
    const auto* reflectance = surfaces.reflectance.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (is_edge[x] != 0) {
        const float rank = 1.0F / (1.0F + std::exp(1.702F * noise_row[x]));  // the normal distribution's, nearly
        if (rank < edge_loss) row[x] = kNoValue;
      } else if (is_near_edge[x] == 0) {
        const float z_sq = row[x] * row[x];
        const float wobble = std::max(0.2F, 1.0F + 0.25F * noise_row[x]);
        const float limit = wobble * wobble * (1.0F + slant_sq[x]);
        const bool flat = cosine_sq * limit > 1.0F;
        const bool dark = reflectance[x] * reflectance[x] < signal_sq * limit * z_sq * z_sq;
        if (flat || dark) row[x] = kNoValue;
      }
    }
  }
}

bool needs_edges(const DepthVariation& camera) {
  return camera.jitter_px > 0.0 || camera.flying_pixel_fraction > 0.0 || camera.edge_loss > 0.0 ||
         camera.min_cosine > 0.0 || camera.min_signal > 0.0;
}

}  // namespace

void apply_depth(const CameraRandomisation& camera, const Camera& view, cv::Mat& depth, Random& random,
                 const cv::Mat& colour) {
  const DepthVariation& made = camera.depth;
  const Surfaces surfaces = find_surfaces(depth, colour, view.fx);
  grow(made.grown_px, depth);
  const Edges edges = needs_edges(made) ? find_edges(depth) : Edges{};
  blur_edges(made, edges, depth, random);
  if (made.kind == DepthKind::kStructuredLight) {
    cast_shadow(made.shadow_m, view.fx, depth);
    add_structured_noise(made, surfaces, depth, random);
    quantise_disparity(made.disparity_step_px, depth);
  } else {
    add_time_of_flight_noise(made, surfaces, depth, random);
  }
  smooth(made, depth);
  make_holes(made, edges, surfaces, depth, random);
  if (made.scale != 1.0) depth *= made.scale;
  shift(made.offset_px, depth);
}

}  // namespace houghstream::training
