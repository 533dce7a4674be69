#include "pose/seen/handle_observation.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/no_value.hpp"
#include "pose/model/symmetry.hpp"

namespace houghstream {
namespace {

constexpr double kInformativeFraction = 0.1;  // fraction of a handle's points that is more than noise

/// Returns how far a point is along an axis, and away from it.
Eigen::Vector2d about_axis(const ContinuousSymmetry& axis, const Eigen::Vector3d& point) {
  const double along = (point - axis.offset).dot(axis.axis);
  return {along, (point - axis.offset - along * axis.axis).norm()};
}

}  // namespace

double HandleObservation::support() const {
  return points == 0 ? 0.0 : (agreeing - contradicting) / points;
}

bool HandleObservation::is_visible() const {
  return agreeing > kInformativeFraction * points && agreeing > contradicting;
}

bool HandleObservation::can_be_occluded() const {
  return std::max(agreeing, contradicting) <= kInformativeFraction * points;
}

HandleObserver::HandleObserver(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                               const DepthTolerance& tolerance)
    : observation_(observation), T_camera_object_(T_camera_object), tolerance_(tolerance) {
  if (observation.model.unround_points.empty()) return;
  constexpr double kMargin_m = 0.01;
  for (const Eigen::Vector3f& point : observation.model.unround_points) {
    const Eigen::Vector2d at = about_axis(*observation.model.nearly_round, point.cast<double>());
    swept_.extend(Eigen::Vector2d(at.x() + kMargin_m, at.y() + kMargin_m));
    swept_.extend(Eigen::Vector2d(at.x() - kMargin_m, 0.0));  // the body too: its inside shows other colours
  }
  rendered_ = render_depth_region(observation.model.mesh, T_camera_object, observation.frame.camera);
  colours_ = compare_colours();
}

/// Learns the object's colours where depth agrees with the model, and those beside it where no handle can be.
std::optional<ColourDiscriminant> HandleObserver::compare_colours() const {
  const cv::Mat& lab = observation_.colours.lab;
  if (!observation_.model.is_unround_alike || lab.empty()) return std::nullopt;
  ColourMoments object;
  ColourMoments beside;
  for (int y = 0; y < lab.rows; ++y) {
    for (int x = 0; x < lab.cols; ++x) {
      const cv::Point at = cv::Point(x, y) + observation_.colours.origin_px;
      const float model = rendered_depth(at);
      if (std::isnan(model)) {
        if (!can_be_handle(at)) beside.add(lab.at<cv::Vec3b>(y, x));
      } else if (std::abs(observation_.frame.depth.at<float>(at) - model) <= tolerance_.at(model)) {
        object.add(lab.at<cv::Vec3b>(y, x));
      }
    }
  }
  return ColourDiscriminant::between(object, beside);
}

/// Returns whether the surface that is measured at a pixel is where the handle is at some turn.
bool HandleObserver::can_be_handle(const cv::Point& at_px) const {
  const float depth = observation_.frame.depth.at<float>(at_px);
  if (std::isnan(depth)) return false;
  const Eigen::Vector3d point = observation_.frame.camera.backproject(at_px.x, at_px.y, depth);
  return swept_.contains(about_axis(*observation_.model.nearly_round, T_camera_object_.inverse() * point));
}

float HandleObserver::rendered_depth(const cv::Point& at_px) const {
  return rendered_.region_px.contains(at_px) ? rendered_.depth.at<float>(at_px - rendered_.region_px.tl()) : kNoValue;
}

HandleObservation HandleObserver::observe_at(const Eigen::Isometry3d& T_camera_object) const {
  HandleObservation observed;
  const cv::Rect image(cv::Point(), observation_.frame.depth.size());
  observed.points = static_cast<int>(observation_.model.unround_points.size());
  for (const Eigen::Vector3f& point : observation_.model.unround_points) {
    const Eigen::Vector3d at = T_camera_object * point.cast<double>();
    if (!(at.z() > 0.0)) continue;
    const Eigen::Vector2d pixel = observation_.frame.camera.project(at);
    const cv::Point nearest_px(cvRound(std::clamp(pixel.x(), -1.0, 1.0 * image.width)),
                               cvRound(std::clamp(pixel.y(), -1.0, 1.0 * image.height)));
    if (!image.contains(nearest_px)) continue;
    const double evidence = evidence_at(nearest_px, at.z());
    (evidence > 0.0 ? observed.agreeing : observed.contradicting) += std::abs(evidence);
  }
  return observed;
}

double HandleObserver::colour_evidence(const cv::Point& at_px) const {
  const LabRegion& colours = observation_.colours;
  const cv::Point in_region = at_px - colours.origin_px;
  const bool is_known = colours_ && cv::Rect(cv::Point(), colours.lab.size()).contains(in_region);
  return is_known ? colours_->evidence(colours.lab.at<cv::Vec3b>(in_region)) : 0.0;
}

/// Returns the evidence for a point of the handle at a pixel, -1 to 1.
double HandleObserver::evidence_at(const cv::Point& at_px, double model_depth) const {
  // Less than the tolerance of other comparisons, as tables and neighbours touch handles.
  constexpr double kToleranceRatio = 0.4;
  constexpr double kDepthAlone = 0.5;
  constexpr double kColourAlone = 0.5;
  const double limit = kToleranceRatio * tolerance_.at(model_depth);
  const double difference = static_cast<double>(observation_.frame.depth.at<float>(at_px)) - model_depth;
  const bool is_on_body = !std::isnan(rendered_depth(at_px));
  const double colour = colour_evidence(at_px);
  if (std::isnan(difference)) return is_on_body ? 0.0 : kColourAlone * colour;
  if (difference < -limit) return 0.0;
  // A depth camera may see past what is thin, where the colours show it.
  if (difference > limit) return !is_on_body && colour > kColourAlone ? 0.0 : -1.0;
  return colours_ ? colour : kDepthAlone;
}

std::optional<Eigen::Isometry3d> HandleObserver::find_turn() const {
  constexpr int kSteps = 48;          // 7.5 degrees: half the thickness of a mug's handle
  constexpr double kMinGain = 0.125;  // of support; found in 80 images of furnished rooms, as the numbers above
  if (observation_.model.unround_points.empty()) return std::nullopt;
  const ContinuousSymmetry& axis = *observation_.model.nearly_round;
  double best = observe_at(T_camera_object_).support() + kMinGain;
  std::optional<Eigen::Isometry3d> found;
  for (int i = 1; i < kSteps; ++i) {
    const Eigen::Isometry3d turned = T_camera_object_ * rotation_about(axis, 2.0 * M_PI * i / kSteps);
    const double support = observe_at(turned).support();
    if (!(support > best)) continue;
    best = support;
    found = turned;
  }
  return found;
}

}  // namespace houghstream
