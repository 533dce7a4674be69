#include "pose/verification/texture_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "pipeline/geometry/renderer.hpp"
#include "pose/model/symmetry.hpp"
#include "pose/seen/depth_score.hpp"
#include "pose/verification/equivalent_poses.hpp"

namespace houghstream {
namespace {

// The numbers below are chosen by what they mean, not fitted; what the result is worth is learnt (TextureSettings).
constexpr int kMinCells = 60;  // minimum number of compared cells that is informative
constexpr int kFine = 5;       // sides of the box filters that separate the bands, cells
constexpr int kCoarse = 13;
// Number of compared cells of the coarser bands that count as one observation.
constexpr double kMiddleCells = 25.0;
constexpr double kCoarseCells = 85.0;
constexpr double kNoise = 8.0;           // variance of a channel without texture and shading, 8-bit CIE L*a*b*
constexpr double kBlur_px = 1.0;         // standard deviation of a camera's blur, by its lens and its mosaic of colours
constexpr double kMinTextureGain = 0.3;  // at the model's exposure
constexpr double kMaxTextureGain = 2.5;
constexpr double kMinLogLikelihoodGain = 1.0;  // gain from which on a rotation follows more than noise

/// Holds a band of one colour channel: one number for each compared cell, and the sum of their squares.
struct Band {
  Eigen::VectorXf values;
  double sum_sq = 0.0;
};

constexpr std::size_t kBands = 8;  // fine L a b, middle L a b, coarse a b
constexpr std::array<double, kBands> kCellsPerObservation = {kObservationCells, kObservationCells, kObservationCells,
                                                             kMiddleCells,      kMiddleCells,      kMiddleCells,
                                                             kCoarseCells,      kCoarseCells};

/// The bands of an image, and its mean colour.
struct TextureBands {
  std::array<Band, kBands> bands;
  double lightness = 0.0;                            ///< mean L*, 8-bit scale
  Eigen::Vector2d chroma = Eigen::Vector2d::Zero();  ///< mean a* and b*, about grey
};

/// The visible part of the object's surface, in cells of some pixels each.
struct VisibleSurface {
  int cell_px = 1;
  cv::Rect part_px;      ///< part of the frame, a whole number of cells
  cv::Mat mask;          ///< CV_32FC1, 1 for the compared cells
  cv::Mat fine_weights;  ///< CV_32FC3, in each channel the compared cells about each cell
  cv::Mat coarse_weights;
  cv::Mat blur_weights;  ///< CV_32FC3, what the camera's blur keeps of each compared cell; empty where cells are larger
  std::vector<cv::Point> cells;                               ///< compared cells, row by row
  std::vector<Eigen::Vector3f> points;                        ///< surface point of each cell, object frame, metres
  Eigen::Vector3f camera_position = Eigen::Vector3f::Zero();  ///< object frame, metres
};

/// Holds an equivalent pose, and the model's texture at it.
struct Alternative {
  Eigen::Isometry3d T_camera_object;
  TextureBands texture;
  double log_likelihood = 0.0;   ///< best_log_likelihood_ratio() of the texture
  double shape_log_ratio = 0.0;  ///< EquivalentPose::log_ratio by silhouettes or handle alone
};

// The steps of compare_with_alternatives(); they stand behind it in the order of their calls.
TextureComparison compare_likelihoods(const std::vector<EquivalentPose>& alternatives);
VisibleSurface find_visible_surface(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                    const RenderedRegion& rendered, const DepthTolerance& tolerance);
cv::Rect crop_to_whole_cells(const cv::Rect& part, int cell_px);
cv::Point middle_px(const cv::Point& cell, const VisibleSurface& surface);
bool is_overexposed(const cv::Vec3b& bgr);
cv::Mat count_cells_around(const cv::Mat& mask, int side);
cv::Mat blurred(const cv::Mat& values, int cell_px);
cv::Mat three_channels(const cv::Mat& weight);
std::optional<TextureBands> model_texture(const ObjectModel& model, const VisibleSurface& surface,
                                          const Eigen::Isometry3d& motion);
std::vector<TextureBands> observed_textures(const ObjectObservation& observation, const VisibleSurface& surface);
TextureBands observed_texture(const ObjectObservation& observation, const VisibleSurface& surface,
                              const cv::Point& shift_px);
TextureBands make_texture_bands(const cv::Mat& lab, const VisibleSurface& surface);
cv::Mat box_sum(const cv::Mat& values, int side);
double best_log_likelihood_ratio(const TextureBands& model, const std::vector<TextureBands>& observed);
double log_likelihood_ratio(const TextureBands& model, const TextureBands& observed);
void align_about_axes(const ObjectModel& model, const VisibleSurface& surface, const Eigen::Isometry3d& T_object_camera,
                      const std::vector<TextureBands>& observed, Alternative& pose);
std::vector<Alternative> rank_alternatives(const ObjectObservation& observation, const VisibleSurface& surface,
                                           const Eigen::Isometry3d& T_camera_object,
                                           const std::vector<EquivalentPose>& poses,
                                           const std::vector<TextureBands>& observed);

}  // namespace

std::optional<TextureComparison> compare_with_alternatives(const ObjectObservation& observation,
                                                           const Eigen::Isometry3d& T_camera_object,
                                                           const DepthTolerance& tolerance,
                                                           const RegistrationSettings& registration) {
  const ObjectModel& model = observation.model;
  if (model.alternatives.empty() && model.near_alternatives.empty() && model.partial_alternatives.empty())
    return std::nullopt;
  const RenderedRegion rendered = render_depth_region(model.mesh, T_camera_object, observation.frame.camera);
  const std::vector<EquivalentPose> alternatives =
      find_equivalent_poses(observation, T_camera_object, rendered, tolerance, registration);
  if (alternatives.empty()) return std::nullopt;
  if (observation.model.texture.empty() || observation.colours.lab.empty()) return compare_likelihoods(alternatives);
  const VisibleSurface surface = find_visible_surface(observation, T_camera_object, rendered, tolerance);
  if (surface.cells.size() < kMinCells) return compare_likelihoods(alternatives);
  std::optional<TextureBands> texture = model_texture(observation.model, surface, Eigen::Isometry3d::Identity());
  if (!texture) return compare_likelihoods(alternatives);
  const std::vector<TextureBands> observed = observed_textures(observation, surface);
  const double log_likelihood = best_log_likelihood_ratio(*texture, observed);
  Alternative pose{T_camera_object, *std::move(texture), log_likelihood};
  align_about_axes(observation.model, surface, T_camera_object.inverse(), observed, pose);
  std::vector<EquivalentPose> compared;
  for (const Alternative& alternative :
       rank_alternatives(observation, surface, T_camera_object, alternatives, observed)) {
    compared.push_back(
        {alternative.T_camera_object, alternative.log_likelihood + alternative.shape_log_ratio - pose.log_likelihood});
  }
  if (compared.empty()) return std::nullopt;
  TextureComparison comparison = compare_likelihoods(compared);
  if (pose.log_likelihood > log_likelihood + kMinLogLikelihoodGain) comparison.aligned = pose.T_camera_object;
  return comparison;
}

namespace {

/// Returns the margin over the alternatives, and the likeliest of them where it replaces the pose. Where nothing is
/// known of them, all are equally probable.
TextureComparison compare_likelihoods(const std::vector<EquivalentPose>& alternatives) {
  // Another pose replaces the present one on positive evidence, a Bayes factor of 3 (Kass and Raftery 1995, "Bayes
  // Factors").
  constexpr double kMinLogBayesFactor = 1.1;  // its logarithm
  TextureComparison comparison;
  double best = kMinLogBayesFactor;
  double ratio_sum = 0.0;  // sum of the alternatives' likelihoods over the pose's
  for (const EquivalentPose& alternative : alternatives) {
    ratio_sum += std::exp(std::min(alternative.log_ratio, 50.0));
    if (!(alternative.log_ratio > best)) continue;
    best = alternative.log_ratio;
    comparison.better = alternative.T_camera_object;
  }
  comparison.margin = -std::log(ratio_sum);
  return comparison;
}

/// Finds the cells where the model is visible. Those of its outline are left out, since colours are registered to depth
/// within a few pixels only.
VisibleSurface find_visible_surface(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                    const RenderedRegion& rendered, const DepthTolerance& tolerance) {
  VisibleSurface surface;
  const cv::Rect colours(observation.colours.origin_px, observation.colours.lab.size());
  const cv::Rect part = rendered.region_px & colours;
  surface.cell_px = std::max(1, (std::max(part.width, part.height) + kObjectCells - 1) / kObjectCells);
  surface.part_px = crop_to_whole_cells(part, surface.cell_px);
  if (surface.part_px.area() == 0) return surface;
  cv::Mat inlier_cells(surface.part_px.size() / surface.cell_px, CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < inlier_cells.rows; ++y) {
    for (int x = 0; x < inlier_cells.cols; ++x) {
      const cv::Point at = middle_px({x, y}, surface);
      const float model = rendered.depth_at(at);
      const float depth_difference =
          observation.frame.depth.at<float>(at) - model;  // NaN where nothing is rendered or measured
      const bool is_inlier = std::abs(depth_difference) <= tolerance.at(model);
      inlier_cells.at<std::uint8_t>(y, x) =
          is_inlier && !is_overexposed(observation.frame.colour.at<cv::Vec3b>(at)) ? 1 : 0;
    }
  }
  cv::erode(inlier_cells, inlier_cells, cv::Mat(), cv::Point(-1, -1), 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  inlier_cells.convertTo(surface.mask, CV_32F);
  surface.fine_weights = count_cells_around(surface.mask, kFine);
  surface.coarse_weights = count_cells_around(surface.mask, kCoarse);
  constexpr int kMaxBlurredCell_px = 3;  // larger cells average away more than the camera blurs
  if (surface.cell_px <= kMaxBlurredCell_px) {
    surface.blur_weights = three_channels(blurred(surface.mask, surface.cell_px));
    surface.blur_weights.setTo(cv::Scalar::all(1.0), surface.mask == 0.0);
  }
  cv::findNonZero(inlier_cells, surface.cells);
  const Eigen::Isometry3d T_object_camera = T_camera_object.inverse();
  for (const cv::Point& cell : surface.cells) {
    const cv::Point at = middle_px(cell, surface);
    const double z = rendered.depth_at(at);
    surface.points.push_back((T_object_camera * observation.frame.camera.backproject(at.x, at.y, z)).cast<float>());
  }
  surface.camera_position = T_object_camera.translation().cast<float>();
  return surface;
}

cv::Rect crop_to_whole_cells(const cv::Rect& part, int cell_px) {
  return {part.x, part.y, part.width / cell_px * cell_px, part.height / cell_px * cell_px};
}

/// Returns the pixel in the frame at a cell's middle.
cv::Point middle_px(const cv::Point& cell, const VisibleSurface& surface) {
  return surface.part_px.tl() + surface.cell_px * cell + cv::Point(surface.cell_px / 2, surface.cell_px / 2);
}

/// Returns whether a pixel is clipped in all channels. A pixel that is clipped in one or two channels keeps its colour,
/// as far as the camera can show it.
bool is_overexposed(const cv::Vec3b& bgr) {
  constexpr std::uint8_t kLimit = 245;
  return std::min({bgr[0], bgr[1], bgr[2]}) >= kLimit;
}

cv::Mat count_cells_around(const cv::Mat& mask, int side) {
  cv::Mat weight;
  cv::max(box_sum(mask, side), 1.0, weight);
  return three_channels(weight);
}

/// Returns values, 0 where nothing is compared, after a camera's blur.
cv::Mat blurred(const cv::Mat& values, int cell_px) {
  const double deviation = kBlur_px / cell_px;  // cells
  cv::Mat result;
  cv::GaussianBlur(values, result, cv::Size(), deviation, deviation, cv::BORDER_CONSTANT);
  return result;
}

cv::Mat three_channels(const cv::Mat& weight) {
  const std::array<cv::Mat, 3> channels = {weight, weight, weight};
  cv::Mat weights;
  cv::merge(channels.data(), channels.size(), weights);
  return weights;
}

/// Returns the model's texture on the surface after `motion`, as blurred as the camera shows it; nothing where much of
/// the surface would be missing.
std::optional<TextureBands> model_texture(const ObjectModel& model, const VisibleSurface& surface,
                                          const Eigen::Isometry3d& motion) {
  constexpr double kMaxMissing = 0.2;
  const Eigen::Isometry3f inverse_motion = motion.inverse().cast<float>();
  cv::Mat grid(surface.mask.size(), CV_32FC3, cv::Scalar::all(0.0));
  std::vector<cv::Point> missing;
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (std::size_t i = 0; i < surface.cells.size(); ++i) {
    const Eigen::Vector3f point = inverse_motion * surface.points[i];
    const std::optional<Eigen::Vector3f> colour =
        model.texture.find(point, inverse_motion * surface.camera_position - point);
    if (!colour) {
      missing.push_back(surface.cells[i]);
      continue;
    }
    const cv::Vec3f lab(colour->x(), colour->y(), colour->z());
    grid.at<cv::Vec3f>(surface.cells[i]) = lab;
    sum += lab;
  }
  if (static_cast<double>(missing.size()) > kMaxMissing * static_cast<double>(surface.cells.size()))
    return std::nullopt;
  const cv::Vec3f mean = sum / static_cast<float>(surface.cells.size() - missing.size());
  for (const cv::Point& cell : missing) grid.at<cv::Vec3f>(cell) = mean;
  if (!surface.blur_weights.empty()) {
    grid = blurred(grid, surface.cell_px) / surface.blur_weights;
    grid.setTo(cv::Scalar::all(0.0), surface.mask == 0.0);
  }
  return make_texture_bands(grid, surface);
}

/// Returns the observed texture, read at a few offsets, since the registration of colour to depth is no better.
std::vector<TextureBands> observed_textures(const ObjectObservation& observation, const VisibleSurface& surface) {
  constexpr int kReach_px = 2;
  std::vector<TextureBands> textures;
  for (const int dy : {0, -kReach_px, kReach_px}) {
    for (const int dx : {0, -kReach_px, kReach_px})
      textures.push_back(observed_texture(observation, surface, {dx, dy}));
  }
  return textures;
}

/// Returns the observed texture of the surface, read at an offset of `shift_px`.
TextureBands observed_texture(const ObjectObservation& observation, const VisibleSurface& surface,
                              const cv::Point& shift_px) {
  const cv::Mat& lab = observation.colours.lab;
  const cv::Point last(lab.cols - surface.part_px.width, lab.rows - surface.part_px.height);
  cv::Point first = surface.part_px.tl() + shift_px - observation.colours.origin_px;
  first = {std::clamp(first.x, 0, last.x), std::clamp(first.y, 0, last.y)};
  cv::Mat grid;
  cv::resize(lab(cv::Rect(first, surface.part_px.size())), grid, surface.mask.size(), 0.0, 0.0, cv::INTER_AREA);
  grid.convertTo(grid, CV_32F);
  grid.setTo(cv::Scalar::all(0.0), surface.mask == 0.0);
  return make_texture_bands(grid, surface);
}

/// Makes the bands of a grid of CIE L*a*b* colours, CV_32FC3, 0 where nothing is compared.
TextureBands make_texture_bands(const cv::Mat& lab, const VisibleSurface& surface) {
  const cv::Mat fine = box_sum(lab, kFine) / surface.fine_weights;
  const cv::Mat coarse = box_sum(lab, kCoarse) / surface.coarse_weights;
  const auto count = static_cast<Eigen::Index>(surface.cells.size());
  cv::Vec3d mean(0.0, 0.0, 0.0);
  for (const cv::Point& cell : surface.cells) mean += cv::Vec3d(lab.at<cv::Vec3f>(cell));
  mean /= static_cast<double>(count);
  TextureBands texture;
  for (Band& band : texture.bands) band.values.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const cv::Point& cell = surface.cells[static_cast<std::size_t>(i)];
    const cv::Vec3f& cell_colour = lab.at<cv::Vec3f>(cell);
    const cv::Vec3f& fine_mean = fine.at<cv::Vec3f>(cell);
    const cv::Vec3f& coarse_mean = coarse.at<cv::Vec3f>(cell);
    for (int c = 0; c < 3; ++c) {
      texture.bands[static_cast<std::size_t>(c)].values[i] = cell_colour[c] - fine_mean[c];
      texture.bands[static_cast<std::size_t>(3 + c)].values[i] = fine_mean[c] - coarse_mean[c];
      if (c > 0)
        texture.bands[static_cast<std::size_t>(5 + c)].values[i] = coarse_mean[c] - static_cast<float>(mean[c]);
    }
  }
  for (Band& band : texture.bands) band.sum_sq = static_cast<double>(band.values.squaredNorm());
  constexpr double kGrey = 128.0;
  texture.lightness = mean[0];
  texture.chroma = {mean[1] - kGrey, mean[2] - kGrey};
  return texture;
}

cv::Mat box_sum(const cv::Mat& values, int side) {
  cv::Mat sum;
  cv::boxFilter(values, sum, -1, cv::Size(side, side), cv::Point(-1, -1), false, cv::BORDER_CONSTANT);
  return sum;
}

double best_log_likelihood_ratio(const TextureBands& model, const std::vector<TextureBands>& observed) {
  double best = log_likelihood_ratio(model, observed.front());
  for (std::size_t i = 1; i < observed.size(); ++i) best = std::max(best, log_likelihood_ratio(model, observed[i]));
  return best;
}

/// Returns the log likelihood ratio of the observation under the model's texture and under a uniform surface.
double log_likelihood_ratio(const TextureBands& model, const TextureBands& observed) {
  // Less light scales all colours of CIE L*a*b*, with L* + 16 in place of L*.
  constexpr double kOffset = 16.0 * 255.0 / 100.0;
  const double exposure =
      std::clamp((observed.lightness + kOffset) / (model.lightness + kOffset), kMinTextureGain, 1.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < kBands; ++i) {
    const Band& model_band = model.bands[i];
    const Band& observed_band = observed.bands[i];
    const auto count = static_cast<double>(observed_band.values.size());
    const auto product = static_cast<double>(model_band.values.dot(observed_band.values));
    const double gain =
        std::clamp(product / std::max(model_band.sum_sq, 1e-6), exposure * kMinTextureGain, kMaxTextureGain);
    const double residual_sq = std::max(0.0, observed_band.sum_sq - gain * (2.0 * product - gain * model_band.sum_sq));
    sum -= 0.5 * count / kCellsPerObservation[i] *
           std::log((residual_sq / count + kNoise) / (observed_band.sum_sq / count + kNoise));
  }
  // A cast, and a camera's saturation, move the mean chroma; by much more than this they do not.
  constexpr double kCast = 14.0;
  constexpr double kMax = 4.0;  // deviations
  const double strength =
      std::clamp(model.chroma.dot(observed.chroma) / std::max(model.chroma.squaredNorm(), 1.0), 0.5, kMaxTextureGain);
  const double chroma_deviation = std::min((observed.chroma - strength * model.chroma).norm() / kCast, kMax);
  return kEvidenceTempering * sum - 0.5 * chroma_deviation * chroma_deviation;
}

/// Turns a pose about the model's axes of revolution to where its texture agrees best with the observed one, by steps
/// from half the distance of two samples (ObjectModel::alternatives) down to two degrees.
void align_about_axes(const ObjectModel& model, const VisibleSurface& surface, const Eigen::Isometry3d& T_object_camera,
                      const std::vector<TextureBands>& observed, Alternative& pose) {
  constexpr double kFirstStep_rad = M_PI / 24.0;
  constexpr int kSteps = 3;
  for (const ContinuousSymmetry& axis : model.shape_symmetries.continuous) {
    double step_rad = kFirstStep_rad;
    for (int i = 0; i < kSteps; ++i, step_rad *= 0.5) {
      const Eigen::Isometry3d start = pose.T_camera_object;
      for (const double angle_rad : {step_rad, -step_rad}) {
        const Eigen::Isometry3d rotated = start * rotation_about(axis, angle_rad);
        std::optional<TextureBands> texture = model_texture(model, surface, T_object_camera * rotated);
        if (!texture) continue;
        const double log_likelihood = best_log_likelihood_ratio(*texture, observed);
        if (log_likelihood > pose.log_likelihood)
          pose = {rotated, *std::move(texture), log_likelihood, pose.shape_log_ratio};
      }
    }
  }
}

/// Returns the alternatives with their texture, the likeliest first. Only the first of many are aligned.
std::vector<Alternative> rank_alternatives(const ObjectObservation& observation, const VisibleSurface& surface,
                                           const Eigen::Isometry3d& T_camera_object,
                                           const std::vector<EquivalentPose>& poses,
                                           const std::vector<TextureBands>& observed) {
  constexpr std::size_t kMaxAligned = 8;
  const auto is_likelier = [](const Alternative& a, const Alternative& b) {
    return a.log_likelihood + a.shape_log_ratio > b.log_likelihood + b.shape_log_ratio;
  };
  const Eigen::Isometry3d T_object_camera = T_camera_object.inverse();
  std::vector<Alternative> ranked;
  for (const EquivalentPose& pose : poses) {
    std::optional<TextureBands> texture =
        model_texture(observation.model, surface, T_object_camera * pose.T_camera_object);
    if (!texture) continue;
    const double log_likelihood = best_log_likelihood_ratio(*texture, observed);
    ranked.push_back({pose.T_camera_object, *std::move(texture), log_likelihood, pose.log_ratio});
  }
  std::stable_sort(ranked.begin(), ranked.end(), is_likelier);
  for (std::size_t i = 0; i < std::min(kMaxAligned, ranked.size()); ++i)
    align_about_axes(observation.model, surface, T_object_camera, observed, ranked[i]);
  return ranked;
}

}  // namespace

}  // namespace houghstream
