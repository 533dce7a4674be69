#include "pose/following/region_modality.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace houghstream {
namespace {

constexpr int kFunctionSegments = 8;  // segments of the smoothed step functions; beyond these a pixel's side is certain
constexpr int kLineSegments = kEdgePositions + kFunctionSegments - 1;
// Amplitude of the steps, with their slope: the probability that a noisy pixel is on the other side.
constexpr float kAmplitude = 0.43F;
constexpr float kSlope = 0.5F;
constexpr float kMinVariance = 0.5F;  // variance of an edge between two sides that differ without doubt, segments^2
constexpr int kMinClear = 3;          // segments to each side of an edge without another one
constexpr float kFirst = -0.5F * (kEdgePositions - 1);

using SegmentValues = std::array<float, kLineSegments>;

/// Returns the probability that a pixel is on the model, by its segments outwards from the edge: h_f of SRT3D, equation
/// 6.
std::array<float, kFunctionSegments> step_function() {
  std::array<float, kFunctionSegments> values{};
  for (int j = 0; j < kFunctionSegments; ++j) {
    const float x = static_cast<float>(j) - 0.5F * (kFunctionSegments - 1);
    values[static_cast<std::size_t>(j)] = 0.5F - kAmplitude * std::tanh(x / (2.0F * kSlope));
  }
  return values;
}

/// A point of the silhouette in a frame.
struct ProjectedSilhouettePoint {
  const SilhouettePoint& at;
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  Eigen::Vector2f normal = Eigen::Vector2f::Zero();  // unit vector out of the model
  float z = 0.0F;                                    // metres
};

std::optional<ProjectedSilhouettePoint> project_point(const RegionView& view, const SilhouettePoint& at,
                                                      const Eigen::Isometry3f& T) {
  const Eigen::Vector3f point = T * at.point;
  if (!(point.z() > 0.0F)) return std::nullopt;
  ProjectedSilhouettePoint projected{at};
  projected.pixel = view.frame.camera.project_single(point);
  projected.normal = (T.linear() * at.normal).head<2>();
  const float length = projected.normal.norm();
  if (!(length > 0.1F) || !projected.pixel.allFinite()) return std::nullopt;
  projected.normal /= length;
  projected.z = point.z();
  return projected;
}

bool is_in_image(const RgbdFrame& frame, const Eigen::Vector2f& pixel) {
  return pixel.x() >= 0.0F && pixel.y() >= 0.0F && pixel.x() <= static_cast<float>(frame.colour.cols - 1) &&
         pixel.y() <= static_cast<float>(frame.colour.rows - 1);
}

cv::Point nearest_pixel(const Eigen::Vector2f& pixel) {
  return {static_cast<int>(pixel.x() + 0.5F), static_cast<int>(pixel.y() + 0.5F)};
}

/// Returns whether depth beside the point, from `first_px` to `last_px` along the normal, is nearer than the model can
/// be.
bool is_point_occluded(const RegionView& view, const ProjectedSilhouettePoint& point, const cv::Range& along_px,
                       double occlusion_m) {
  const double margin = occlusion_m + 3.0 * view.noise.sigma(point.z);
  const auto limit = static_cast<float>(point.z - point.at.nearer_m - margin);
  for (int step = along_px.start; step < along_px.end; ++step) {
    const Eigen::Vector2f at = point.pixel + static_cast<float>(step) * point.normal;
    if (is_in_image(view.frame, at) && view.frame.depth.at<float>(nearest_pixel(at)) < limit) return true;
  }
  return false;
}

/// Products of the pixels' probabilities over each segment, outwards; those of both sides are normalised.
struct SegmentProbabilities {
  SegmentValues foreground{};
  SegmentValues background{};
  float contrast = 0.0F;  // RegionLine::contrast
};

/// The middle of the line's middle segment, and how far it leads to each side.
struct LineOfPixels {
  Eigen::Vector2f middle = Eigen::Vector2f::Zero();
  Eigen::Vector2f step = Eigen::Vector2f::Zero();  // step to the next pixel along the axis that is nearer to the normal
  float offset_px = 0.0F;                          // offset from the point to the middle, steps
};

/// Segments begin and end between pixels of the axis that is nearer to the normal.
LineOfPixels line_through(const ProjectedSilhouettePoint& point, int segment_px) {
  LineOfPixels line;
  line.step = point.normal / point.normal.cwiseAbs().maxCoeff();
  const bool is_horizontal = std::abs(line.step.x()) >= std::abs(line.step.y());
  const float along = is_horizontal ? point.pixel.x() * line.step.x() : point.pixel.y() * line.step.y();
  const float middle = segment_px % 2 == 1 ? std::round(along) : std::floor(along) + 0.5F;
  line.offset_px = middle - along;
  line.middle = point.pixel + line.offset_px * line.step;
  return line;
}

std::optional<SegmentProbabilities> segment_probabilities(const RgbdFrame& frame, const LineOfPixels& line,
                                                          int segment_px, const ColourStatistics& colours) {
  const float reach = 0.5F * static_cast<float>(kLineSegments * segment_px - 1);
  if (!is_in_image(frame, line.middle - reach * line.step) || !is_in_image(frame, line.middle + reach * line.step))
    return std::nullopt;
  SegmentProbabilities out;
  int pixel = 0;
  int intensity_foreground = 0;
  int intensity_background = 0;
  for (std::size_t segment = 0; segment < kLineSegments; ++segment) {
    float foreground = 1.0F;
    float background = 1.0F;
    for (int i = 0; i < segment_px; ++i, ++pixel) {
      const Eigen::Vector2f at = line.middle + (static_cast<float>(pixel) - reach) * line.step;
      const cv::Vec3b& colour = frame.colour.at<cv::Vec3b>(nearest_pixel(at));
      const int intensity = colour[0] + 2 * colour[1] + colour[2];
      if (segment < kLineSegments / 2) intensity_foreground += intensity;
      if (segment > kLineSegments / 2) intensity_background += intensity;
      const float probability = colours.foreground(colour);
      foreground *= probability;
      background *= 1.0F - probability;
    }
    out.foreground[segment] = foreground / (foreground + background);
    out.background[segment] = background / (foreground + background);
  }
  const int intensity = intensity_foreground + intensity_background;
  if (intensity > 0)
    out.contrast = static_cast<float>(intensity_foreground - intensity_background) / static_cast<float>(intensity);
  return out;
}

/// Computes the posterior of the edge, SRT3D, equation 9: the product over the segments about each position of what
/// both sides explain of them. Returns false where the posterior has no edge: it rises to an end of the line, or is
/// flat.
bool find_edge(const SegmentProbabilities& segments, RegionLine& line) {
  constexpr float kMaxVariance = 8.0F;  // variance of a flat posterior is 11.9
  static const std::array<float, kFunctionSegments> step = step_function();
  // All positions advance together, so that they share vector units.
  std::array<float, kEdgePositions> products{};
  products.fill(1.0F);
  for (std::size_t j = 0; j < kFunctionSegments; ++j) {
    for (std::size_t i = 0; i < kEdgePositions; ++i)
      products[i] *= step[j] * segments.foreground[i + j] + (1.0F - step[j]) * segments.background[i + j];
  }
  float sum = 0.0F;
  for (const float product : products) sum += product;
  line.posterior = products;
  if (!(sum > 0.0F)) return false;
  float mean = 0.0F;
  for (std::size_t i = 0; i < kEdgePositions; ++i) {
    line.posterior[i] /= sum;
    mean += line.posterior[i] * static_cast<float>(i);
  }
  float variance = 0.0F;
  for (std::size_t i = 0; i < kEdgePositions; ++i) {
    const float apart = static_cast<float>(i) - mean;
    variance += line.posterior[i] * apart * apart;
  }
  const auto top = std::max_element(line.posterior.begin(), line.posterior.end());
  if (top == line.posterior.begin() || top + 1 == line.posterior.end() || variance > kMaxVariance) return false;
  line.mean = line.first + mean;
  line.variance = std::max(variance, kMinVariance);
  return true;
}

/// Returns the derivative of the logarithm of the posterior at a position between two of its values; it is zero beyond
/// them.
float gradient_at(const RegionLine& line, float position) {
  constexpr float kFloor = 1e-12F;
  const float place = position - line.first;
  if (!(place >= 0.0F) || place >= static_cast<float>(kEdgePositions - 1)) return 0.0F;
  const auto below = static_cast<std::size_t>(place);
  return std::log((line.posterior[below + 1] + kFloor) / (line.posterior[below] + kFloor));
}

constexpr double kContrastGain = 4.0;  // sides of which one has 1.7 times the other's brightness differ plainly

/// Errors that all edges of one object share: an unknown displacement outwards, and one towards the darker side. Both
/// are estimated with the motion and marginalised out of its equations (Schur complement), so that an outline that is
/// too large all round does not change the distance.
class CommonError {
 public:
  explicit CommonError(double sigma_px) : is_known_(sigma_px == 0.0) {
    if (!is_known_) hessian_.diagonal().setConstant(1.0 / (sigma_px * sigma_px));
  }

  /// Adds a line of the given row of the motion, weight of its square, weighted pull, and row of the common errors.
  void add(const Vector6d& row, double weight, double weighted_gradient, const Eigen::Vector2d& common_row) {
    hessian_ += weight * common_row * common_row.transpose();
    mixed_ += weight * row * common_row.transpose();
    gradient_ += weighted_gradient * common_row;
  }

  void marginalise(MotionEquations& equations) const {
    if (is_known_) return;
    const Eigen::Matrix<double, 6, 2> gain = mixed_ * hessian_.inverse();
    equations.hessian.triangularView<Eigen::Lower>() -= gain * mixed_.transpose();
    equations.gradient -= gain * gradient_;
  }

 private:
  bool is_known_;
  Eigen::Matrix2d hessian_ = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 6, 2> mixed_ = Eigen::Matrix<double, 6, 2>::Zero();
  Eigen::Vector2d gradient_ = Eigen::Vector2d::Zero();
};

}  // namespace

Vector6d image_motion_row(const RegionView& view, const Eigen::Vector3d& point, const Eigen::Vector2d& direction,
                          const Eigen::Vector3d& centre) {
  const Camera& camera = view.frame.camera;
  const Eigen::Vector2d scaled(direction.x() * camera.fx / point.z(), direction.y() * camera.fy / point.z());
  const Eigen::Vector3d towards(scaled.x(), scaled.y(), -scaled.dot(point.head<2>()) / point.z());
  Vector6d row;
  row << ((point - centre) / view.model.radius).cross(towards), towards;
  return row;
}

RegionLines find_region_lines(const RegionView& view, const Silhouette& silhouette, const ColourStatistics& colours,
                              const Eigen::Isometry3d& T_camera_object, const RegionScale& scale,
                              const RegionModalitySettings& settings) {
  constexpr int kBeside_px = 4;
  RegionLines found;
  found.lines.reserve(silhouette.points.size() / static_cast<std::size_t>(scale.every) + 1);
  const Eigen::Isometry3f T = T_camera_object.cast<float>();
  const auto focal = static_cast<float>(view.frame.camera.fx);
  for (std::size_t i = 0; i < silhouette.points.size(); i += static_cast<std::size_t>(scale.every)) {
    const SilhouettePoint& at = silhouette.points[i];
    const std::optional<ProjectedSilhouettePoint> point = project_point(view, at, T);
    if (!point) continue;
    const LineOfPixels pixels = line_through(*point, scale.segment_px);
    const float segments_per_px = 1.0F / (pixels.step.norm() * static_cast<float>(scale.segment_px));
    const float clear = std::min(at.inside_m, at.outside_m) * focal / point->z * segments_per_px;
    if (clear < kMinClear) continue;
    if (is_point_occluded(view, *point, {-kBeside_px, kBeside_px + 1}, settings.occlusion_m)) {
      ++found.covered;
      continue;
    }
    const std::optional<SegmentProbabilities> segments =
        segment_probabilities(view.frame, pixels, scale.segment_px, colours);
    if (!segments) continue;
    RegionLine line;
    line.point = at.point;
    line.centre_px = point->pixel;
    line.normal = point->normal;
    line.segments_per_px = segments_per_px;
    line.first = kFirst + pixels.offset_px / static_cast<float>(scale.segment_px);
    line.contrast = segments->contrast;
    if (find_edge(*segments, line)) {
      found.lines.push_back(line);
    } else {
      ++found.blank;
    }
  }
  return found;
}

MotionEquations region_equations(const RegionView& view, const std::vector<RegionLine>& lines,
                                 const Eigen::Isometry3d& T_camera_object, const RegionScale& scale, EdgeStep step,
                                 const RegionModalitySettings& settings) {
  MotionEquations equations;
  CommonError common(settings.common_error_px);
  const Eigen::Vector3d centre = T_camera_object * view.model.centre.cast<double>();
  for (const RegionLine& line : lines) {
    const Eigen::Vector3d point = T_camera_object * line.point.cast<double>();
    if (!(point.z() > 0.0)) continue;
    const double per_px = line.segments_per_px;
    const double moved_px =
        line.normal.cast<double>().dot(view.frame.camera.project(point) - line.centre_px.cast<double>());
    const double position = per_px * moved_px;
    // The edge of a line whose two sides differ plainly has the standard deviation of the scale.
    const double weight = static_cast<double>(scale.every) * static_cast<double>(kMinVariance) /
                          (per_px * per_px * scale.sigma_px * scale.sigma_px);
    const double gradient = step == EdgeStep::kToMean
                                ? (line.mean - position) / line.variance
                                : static_cast<double>(gradient_at(line, static_cast<float>(position)));
    const Vector6d row = per_px * image_motion_row(view, point, line.normal.cast<double>(), centre);
    add_outer_product(row, weight / line.variance, equations.hessian);
    equations.gradient += weight * gradient * row;
    common.add(row, weight / line.variance, weight * gradient,
               per_px * Eigen::Vector2d(1.0, std::tanh(kContrastGain * line.contrast)));
  }
  common.marginalise(equations);
  return equations;
}

void learn_colours(const RegionView& view, const Silhouette& silhouette, const Eigen::Isometry3d& T_camera_object,
                   const RegionModalitySettings& settings, ColourStatistics& colours) {
  // A lens mixes both sides at the edge itself; what is learnt of it would confirm any pose that is a little beside.
  constexpr int kGap_px = 3;
  constexpr int kReach_px = 20;
  constexpr int kBeside_px = 4;
  constexpr std::size_t kEvery = 2;  // every second point: its pixels suffice
  std::vector<cv::Vec3b> foreground;
  std::vector<cv::Vec3b> background;
  const Eigen::Isometry3f T = T_camera_object.cast<float>();
  const auto focal = static_cast<float>(view.frame.camera.fx);
  for (std::size_t i = 0; i < silhouette.points.size(); i += kEvery) {
    const SilhouettePoint& at = silhouette.points[i];
    const std::optional<ProjectedSilhouettePoint> point = project_point(view, at, T);
    if (!point) continue;
    const auto collect = [&](float side, float clear_m, std::vector<cv::Vec3b>& pixels) {
      const int clear_px = static_cast<int>(std::min<float>(clear_m * focal / point->z, kReach_px));
      for (int step = kGap_px; step <= clear_px; ++step) {
        const Eigen::Vector2f pixel = point->pixel + side * static_cast<float>(step) * point->normal;
        if (!is_in_image(view.frame, pixel)) return;
        pixels.push_back(view.frame.colour.at<cv::Vec3b>(nearest_pixel(pixel)));
      }
    };
    collect(1.0F, at.outside_m, background);
    if (!is_point_occluded(view, *point, {-kBeside_px, 0}, settings.occlusion_m))
      collect(-1.0F, at.inside_m, foreground);
  }
  colours.learn(foreground, background, settings.colour_rate);
}

cv::Rect silhouette_box(const RegionView& view, const Silhouette& silhouette,
                        const Eigen::Isometry3d& T_camera_object) {
  constexpr float kMargin = 8.0F;
  const Eigen::Isometry3f T = T_camera_object.cast<float>();
  Eigen::AlignedBox2f box;
  for (const SilhouettePoint& at : silhouette.points) {
    const std::optional<ProjectedSilhouettePoint> point = project_point(view, at, T);
    if (point) box.extend(point->pixel);
  }
  if (box.isEmpty()) return {};
  const Eigen::Vector2f last(static_cast<float>(view.frame.depth.cols), static_cast<float>(view.frame.depth.rows));
  const Eigen::Vector2f low = (box.min().array() - kMargin).matrix().cwiseMax(0.0F).cwiseMin(last);
  const Eigen::Vector2f high = (box.max().array() + kMargin).matrix().cwiseMax(0.0F).cwiseMin(last);
  return {cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
          cv::Point(static_cast<int>(high.x()), static_cast<int>(high.y()))};
}

}  // namespace houghstream
