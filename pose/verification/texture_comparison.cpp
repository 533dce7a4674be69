#include "pose/verification/texture_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/geometry/renderer.hpp"
#include "pose/model/symmetry.hpp"
#include "pose/registration/registration.hpp"
#include "pose/seen/depth_score.hpp"

namespace houghstream {
namespace {

// The numbers below are chosen by what they mean, not fitted; what the result is worth is learnt (TextureSettings).
constexpr int kCells = 48;     // along the longer side of the object in the image
constexpr int kMinCells = 60;  // minimum of compared cells that is informative
constexpr int kFine = 5;       // sides of the means that part the bands, cells
constexpr int kCoarse = 13;
// Number of compared cells that count as one observation, since neighbours are correlated. All cells share one image,
// one mesh and one pose, so that even these observations are dependent: kTemper reduces their weight for that.
constexpr double kFineCells = 4.0;
constexpr double kMiddleCells = 25.0;
constexpr double kCoarseCells = 85.0;
constexpr double kTemper = 0.3;
constexpr double kNoise = 8.0;  // variance of a channel without texture and shading, 8-bit CIE L*a*b*
constexpr double kMinGain = 0.3;
constexpr double kMaxGain = 2.5;
constexpr double kInformative = 1.0;  // gain of a log likelihood from which on it is not noise that a rotation follows

/// Holds a band of one colour channel: one number for each compared cell, and the sum of their squares.
struct Band {
  Eigen::VectorXf values;
  double sum_sq = 0.0;
};

constexpr std::size_t kBands = 8;  // fine L a b, middle L a b, coarse a b
constexpr std::array<double, kBands> kCellsOfOne = {kFineCells,   kFineCells,   kFineCells,   kMiddleCells,
                                                    kMiddleCells, kMiddleCells, kCoarseCells, kCoarseCells};

/// The bands of an image, and its mean chroma.
struct TextureBands {
  std::array<Band, kBands> bands;
  Eigen::Vector2d chroma = Eigen::Vector2d::Zero();  ///< mean a* and b*, about grey
};

/// Cells of the object's part of the image where its surface is seen.
struct Face {
  int cell_px = 1;
  cv::Rect part_px;      ///< part of the frame, a whole number of cells
  cv::Mat mask;          ///< CV_32FC1, 1 for the compared cells
  cv::Mat fine_weights;  ///< CV_32FC3, in each channel the compared cells about each cell
  cv::Mat coarse_weights;
  std::vector<cv::Point> cells;                   ///< compared cells, row by row
  std::vector<Eigen::Vector3f> points;            ///< surface points of the cells, object frame, metres
  Eigen::Vector3f eye = Eigen::Vector3f::Zero();  ///< the camera, object frame
};

cv::Mat box_sum(const cv::Mat& values, int side) {
  cv::Mat sum;
  cv::boxFilter(values, sum, -1, cv::Size(side, side), cv::Point(-1, -1), false, cv::BORDER_CONSTANT);
  return sum;
}

cv::Mat cells_about(const cv::Mat& mask, int side) {
  cv::Mat weight;
  cv::max(box_sum(mask, side), 1.0, weight);
  const std::array<cv::Mat, 3> channels = {weight, weight, weight};
  cv::Mat weights;
  cv::merge(channels.data(), channels.size(), weights);
  return weights;
}

/// Makes the bands of a grid of CIE L*a*b* colours, CV_32FC3, 0 where nothing is compared.
TextureBands make_texture_bands(const cv::Mat& lab, const Face& face) {
  const cv::Mat fine = box_sum(lab, kFine) / face.fine_weights;
  const cv::Mat coarse = box_sum(lab, kCoarse) / face.coarse_weights;
  const auto count = static_cast<Eigen::Index>(face.cells.size());
  cv::Vec3d mean(0.0, 0.0, 0.0);
  for (const cv::Point& cell : face.cells) mean += cv::Vec3d(lab.at<cv::Vec3f>(cell));
  mean /= static_cast<double>(count);
  TextureBands texture;
  for (Band& band : texture.bands) band.values.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const cv::Point& cell = face.cells[static_cast<std::size_t>(i)];
    const cv::Vec3f own = lab.at<cv::Vec3f>(cell);
    const cv::Vec3f near = fine.at<cv::Vec3f>(cell);
    const cv::Vec3f wide = coarse.at<cv::Vec3f>(cell);
    for (int c = 0; c < 3; ++c) {
      texture.bands[static_cast<std::size_t>(c)].values[i] = own[c] - near[c];
      texture.bands[static_cast<std::size_t>(3 + c)].values[i] = near[c] - wide[c];
      if (c > 0) texture.bands[static_cast<std::size_t>(5 + c)].values[i] = wide[c] - static_cast<float>(mean[c]);
    }
  }
  for (Band& band : texture.bands) band.sum_sq = static_cast<double>(band.values.squaredNorm());
  constexpr double kGrey = 128.0;
  texture.chroma = {mean[1] - kGrey, mean[2] - kGrey};
  return texture;
}

/// Returns the log likelihood ratio of the observation under the model's texture and under a uniform surface.
double log_likelihood(const TextureBands& model, const TextureBands& observed) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kBands; ++i) {
    const Band& own = model.bands[i];
    const Band& there = observed.bands[i];
    const auto count = static_cast<double>(there.values.size());
    const auto product = static_cast<double>(own.values.dot(there.values));
    const double gain = std::clamp(product / std::max(own.sum_sq, 1e-6), kMinGain, kMaxGain);
    const double left = std::max(0.0, there.sum_sq - gain * (2.0 * product - gain * own.sum_sq));
    sum -= 0.5 * count / kCellsOfOne[i] * std::log((left / count + kNoise) / (there.sum_sq / count + kNoise));
  }
  // A cast, and a camera's saturation, move the mean chroma; by much more than this they do not.
  constexpr double kCast = 14.0;
  constexpr double kMax = 4.0;  // deviations
  const double strength =
      std::clamp(model.chroma.dot(observed.chroma) / std::max(model.chroma.squaredNorm(), 1.0), 0.5, kMaxGain);
  const double apart = std::min((observed.chroma - strength * model.chroma).norm() / kCast, kMax);
  return kTemper * sum - 0.5 * apart * apart;
}

cv::Rect whole_cells(const cv::Rect& part, int cell_px) {
  return {part.x, part.y, part.width / cell_px * cell_px, part.height / cell_px * cell_px};
}

/// Returns whether a pixel is clipped in all channels. A pixel that is clipped in one or two channels keeps its colour,
/// as far as the camera can show it.
bool is_overexposed(const cv::Vec3b& bgr) {
  constexpr std::uint8_t kLimit = 245;
  return std::min({bgr[0], bgr[1], bgr[2]}) >= kLimit;
}

/// Returns the pixel in the frame at a cell's middle.
cv::Point middle_px(const cv::Point& cell, const Face& face) {
  return face.part_px.tl() + face.cell_px * cell + cv::Point(face.cell_px / 2, face.cell_px / 2);
}

/// Cells where the model is seen, its outline's left out: colours are registered to depth within a few pixels.
Face visible_face(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                  const DepthTolerance& tolerance) {
  Face face;
  const RenderedRegion rendered =
      render_depth_region(observation.model.mesh, T_camera_object, observation.frame.camera);
  const cv::Rect colours(observation.colours.origin_px, observation.colours.lab.size());
  const cv::Rect part = rendered.region_px & colours;
  face.cell_px = std::max(1, (std::max(part.width, part.height) + kCells - 1) / kCells);
  face.part_px = whole_cells(part, face.cell_px);
  if (face.part_px.area() == 0) return face;
  cv::Mat agrees(face.part_px.size() / face.cell_px, CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < agrees.rows; ++y) {
    for (int x = 0; x < agrees.cols; ++x) {
      const cv::Point at = middle_px({x, y}, face);
      const float model = rendered.depth.at<float>(at - rendered.region_px.tl());
      const float beyond = observation.frame.depth.at<float>(at) - model;  // NaN where nothing is rendered or measured
      const bool depth_inliers = std::abs(beyond) <= tolerance.at(model);
      agrees.at<std::uint8_t>(y, x) =
          depth_inliers && !is_overexposed(observation.frame.colour.at<cv::Vec3b>(at)) ? 1 : 0;
    }
  }
  cv::erode(agrees, agrees, cv::Mat(), cv::Point(-1, -1), 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  agrees.convertTo(face.mask, CV_32F);
  face.fine_weights = cells_about(face.mask, kFine);
  face.coarse_weights = cells_about(face.mask, kCoarse);
  cv::findNonZero(agrees, face.cells);
  const Eigen::Isometry3d T_object_camera = T_camera_object.inverse();
  for (const cv::Point& cell : face.cells) {
    const cv::Point at = middle_px(cell, face);
    const double z = rendered.depth.at<float>(at - rendered.region_px.tl());
    face.points.push_back((T_object_camera * observation.frame.camera.backproject(at.x, at.y, z)).cast<float>());
  }
  face.eye = T_object_camera.translation().cast<float>();
  return face;
}

/// Returns the observed texture of the face, read at an offset of `shift_px`.
TextureBands observed_texture(const ObjectObservation& observation, const Face& face, const cv::Point& shift_px) {
  const cv::Mat& lab = observation.colours.lab;
  const cv::Point last(lab.cols - face.part_px.width, lab.rows - face.part_px.height);
  cv::Point first = face.part_px.tl() + shift_px - observation.colours.origin_px;
  first = {std::clamp(first.x, 0, last.x), std::clamp(first.y, 0, last.y)};
  cv::Mat grid;
  cv::resize(lab(cv::Rect(first, face.part_px.size())), grid, face.mask.size(), 0.0, 0.0, cv::INTER_AREA);
  grid.convertTo(grid, CV_32F);
  grid.setTo(cv::Scalar::all(0.0), face.mask == 0.0);
  return make_texture_bands(grid, face);
}

/// Returns the model's texture there after `motion`; nothing where much of the surface would be missing.
std::optional<TextureBands> model_texture(const ObjectModel& model, const Face& face, const Eigen::Isometry3d& motion) {
  constexpr double kMaxMissing = 0.2;
  const Eigen::Isometry3f back = motion.inverse().cast<float>();
  cv::Mat grid(face.mask.size(), CV_32FC3, cv::Scalar::all(0.0));
  std::vector<cv::Point> missing;
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (std::size_t i = 0; i < face.cells.size(); ++i) {
    const Eigen::Vector3f point = back * face.points[i];
    const std::optional<Eigen::Vector3f> colour = model.texture.find(point, back * face.eye - point);
    if (!colour) {
      missing.push_back(face.cells[i]);
      continue;
    }
    const cv::Vec3f lab(colour->x(), colour->y(), colour->z());
    grid.at<cv::Vec3f>(face.cells[i]) = lab;
    sum += lab;
  }
  if (static_cast<double>(missing.size()) > kMaxMissing * static_cast<double>(face.cells.size())) return std::nullopt;
  const cv::Vec3f mean = sum / static_cast<float>(face.cells.size() - missing.size());
  for (const cv::Point& cell : missing) grid.at<cv::Vec3f>(cell) = mean;
  return make_texture_bands(grid, face);
}

/// Returns the observed texture, read at a few offsets, since the registration of colour to depth is no better.
std::vector<TextureBands> observed_textures(const ObjectObservation& observation, const Face& face) {
  constexpr int kReach_px = 2;
  std::vector<TextureBands> textures;
  for (const int dy : {0, -kReach_px, kReach_px}) {
    for (const int dx : {0, -kReach_px, kReach_px}) textures.push_back(observed_texture(observation, face, {dx, dy}));
  }
  return textures;
}

double best_log_likelihood(const TextureBands& model, const std::vector<TextureBands>& observed) {
  double best = log_likelihood(model, observed.front());
  for (std::size_t i = 1; i < observed.size(); ++i) best = std::max(best, log_likelihood(model, observed[i]));
  return best;
}

/// Counts of points of the part that breaks a nearly round shape, such as a handle, by how they are observed at a pose.
struct HandleCounts {
  int depth_inliers = 0;
  int free_space_violations = 0;
  int all = 0;
};

HandleCounts look_at_handle(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                            const DepthTolerance& tolerance) {
  HandleCounts counts;
  const cv::Rect image(cv::Point(), observation.frame.depth.size());
  for (const Eigen::Vector3f& point : observation.model.unround_points) {
    const Eigen::Vector3d at = T_camera_object * point.cast<double>();
    ++counts.all;
    if (!(at.z() > 0.0)) continue;
    const Eigen::Vector2d pixel = observation.frame.camera.project(at);
    const cv::Point2d place(std::clamp(pixel.x(), -1.0, 1.0 * image.width),
                            std::clamp(pixel.y(), -1.0, 1.0 * image.height));
    const cv::Point nearest(cvRound(place.x), cvRound(place.y));
    if (!image.contains(nearest)) continue;
    // NaN where not measured.
    const double beyond = static_cast<double>(observation.frame.depth.at<float>(nearest)) - at.z();
    const double limit = tolerance.at(at.z());
    counts.depth_inliers += std::abs(beyond) <= limit ? 1 : 0;
    counts.free_space_violations += beyond > limit ? 1 : 0;
  }
  return counts;
}

bool is_handle_seen(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                    const DepthTolerance& tolerance) {
  constexpr double kSome = 0.1;
  const HandleCounts counts = look_at_handle(observation, T_camera_object, tolerance);
  return counts.depth_inliers > kSome * counts.all;
}

bool may_handle_be_hidden(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                          const DepthTolerance& tolerance) {
  constexpr double kFew = 0.1;
  const HandleCounts counts = look_at_handle(observation, T_camera_object, tolerance);
  return counts.free_space_violations <= kFew * counts.all && counts.depth_inliers <= kFew * counts.all;
}

/// Returns the poses that only the texture distinguishes from this one: those whose depth agrees as well, nearly
/// equivalent ones registered.
std::vector<Eigen::Isometry3d> alternative_poses(const ObjectObservation& observation,
                                                 const Eigen::Isometry3d& T_camera_object,
                                                 const DepthTolerance& tolerance,
                                                 const RegistrationSettings& registration) {
  constexpr int kPoints = 150;
  constexpr float kAsWell = 0.8F;
  const auto agreement_at = [&](const Eigen::Isometry3d& pose) {
    return score_pose(observation.frame, observation.model, pose, kPoints, tolerance).value;
  };
  const float own = agreement_at(T_camera_object);
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Isometry3d& motion : observation.model.alternatives) poses.push_back(T_camera_object * motion);
  const CorrespondenceDistances distances = correspondence_distances(observation, registration);
  for (const Eigen::Isometry3d& motion : observation.model.near_alternatives) {
    const RegistrationResult result =
        register_coarsely(observation, T_camera_object * motion, 0.5 * (distances.start + distances.end), registration);
    if (result.inliers > 0 && agreement_at(result.T_camera_object) >= kAsWell * own)
      poses.push_back(result.T_camera_object);
  }
  if (is_handle_seen(observation, T_camera_object, tolerance)) return poses;
  for (const Eigen::Isometry3d& motion : observation.model.partial_alternatives) {
    const Eigen::Isometry3d rotated = T_camera_object * motion;
    if (may_handle_be_hidden(observation, rotated, tolerance)) poses.push_back(rotated);
  }
  return poses;
}

/// Holds a pose that is equivalent by shape, and the model's texture at it.
struct Alternative {
  Eigen::Isometry3d T_camera_object;
  TextureBands texture;
  double likelihood = 0.0;  ///< log
};

/// Turns a pose about the model's axes of revolution to where its texture agrees best with the observed one, by steps
/// from half the distance of two samples (ObjectModel::alternatives) down to two degrees.
void align_about_axes(const ObjectModel& model, const Face& face, const Eigen::Isometry3d& T_object_camera,
                      const std::vector<TextureBands>& observed, Alternative& pose) {
  constexpr double kFirstStep_rad = M_PI / 24.0;
  constexpr int kSteps = 3;
  for (const ContinuousSymmetry& axis : model.shape_symmetries.continuous) {
    double step_rad = kFirstStep_rad;
    for (int i = 0; i < kSteps; ++i, step_rad *= 0.5) {
      const Eigen::Isometry3d from = pose.T_camera_object;
      for (const double angle_rad : {step_rad, -step_rad}) {
        const Eigen::Isometry3d turned = from * rotation_about(axis, angle_rad);
        std::optional<TextureBands> texture = model_texture(model, face, T_object_camera * turned);
        if (!texture) continue;
        const double likelihood = best_log_likelihood(*texture, observed);
        if (likelihood > pose.likelihood) pose = {turned, *std::move(texture), likelihood};
      }
    }
  }
}

/// Returns the alternatives at which the model's surface agrees with the depth. Of many rotations only the likeliest
/// are aligned.
std::vector<Alternative> likely_alternatives(const ObjectObservation& observation, const Face& face,
                                             const Eigen::Isometry3d& T_camera_object,
                                             const std::vector<Eigen::Isometry3d>& poses,
                                             const std::vector<TextureBands>& seen_at) {
  constexpr std::size_t kAligned = 8;
  const auto is_likelier = [](const Alternative& a, const Alternative& b) { return a.likelihood > b.likelihood; };
  const Eigen::Isometry3d T_object_camera = T_camera_object.inverse();
  std::vector<Alternative> shown;
  for (const Eigen::Isometry3d& pose : poses) {
    std::optional<TextureBands> texture = model_texture(observation.model, face, T_object_camera * pose);
    if (!texture) continue;
    const double likelihood = best_log_likelihood(*texture, seen_at);
    shown.push_back({pose, *std::move(texture), likelihood});
  }
  std::stable_sort(shown.begin(), shown.end(), is_likelier);
  for (std::size_t i = 0; i < std::min(kAligned, shown.size()); ++i)
    align_about_axes(observation.model, face, T_object_camera, seen_at, shown[i]);
  return shown;
}

/// Returns the margin without information from the texture: all alternatives are equally probable.
TextureComparison undecided(std::size_t alternatives) {
  return {-std::log(static_cast<double>(alternatives)), std::nullopt, std::nullopt};
}

}  // namespace

std::optional<TextureComparison> compare_with_alternatives(const ObjectObservation& observation,
                                                           const Eigen::Isometry3d& T_camera_object,
                                                           const DepthTolerance& tolerance,
                                                           const RegistrationSettings& registration) {
  const std::vector<Eigen::Isometry3d> alternatives =
      alternative_poses(observation, T_camera_object, tolerance, registration);
  if (alternatives.empty()) return std::nullopt;
  if (observation.model.texture.empty() || observation.colours.lab.empty()) return undecided(alternatives.size());
  const Face face = visible_face(observation, T_camera_object, tolerance);
  if (face.cells.size() < kMinCells) return undecided(alternatives.size());
  std::optional<TextureBands> own = model_texture(observation.model, face, Eigen::Isometry3d::Identity());
  if (!own) return undecided(alternatives.size());
  const std::vector<TextureBands> seen_at = observed_textures(observation, face);
  const double likelihood = best_log_likelihood(*own, seen_at);
  Alternative pose{T_camera_object, *std::move(own), likelihood};
  align_about_axes(observation.model, face, T_camera_object.inverse(), seen_at, pose);
  const bool is_turned = pose.likelihood > likelihood + kInformative;
  const double own_likelihood = pose.likelihood;
  const std::vector<Alternative> shown = likely_alternatives(observation, face, T_camera_object, alternatives, seen_at);
  if (shown.empty()) return std::nullopt;
  // Another pose replaces the present one on positive evidence, a Bayes factor of 3 (Kass and Raftery 1995, "Bayes
  // Factors").
  constexpr double kClearly = 1.1;  // its logarithm
  TextureComparison comparison;
  if (is_turned) comparison.aligned = pose.T_camera_object;
  double best = own_likelihood + kClearly;
  double others = 0.0;  // sum of likelihoods over the pose's own
  for (const Alternative& other : shown) {
    others += std::exp(std::min(other.likelihood - own_likelihood, 50.0));
    if (!(other.likelihood > best)) continue;
    best = other.likelihood;
    comparison.better = other.T_camera_object;
  }
  comparison.margin = -std::log(others);
  return comparison;
}

}  // namespace houghstream
