#include "tools/view/drawing/teaching_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/types/frame_id.hpp"
#include "tools/view/drawing/overlay.hpp"

namespace houghstream::view {
namespace {

constexpr int kSphere_px = 88;
constexpr int kMargin_px = 6;
constexpr int kLine_px = 18;
const cv::Scalar kSeen(110, 200, 60);
const cv::Scalar kUnseen(95, 90, 86);
const cv::Scalar kNotFollowed(80, 170, 255);

cv::Scalar colour_of(TeachingState state) {
  return state == TeachingState::kLost || state == TeachingState::kFailed ? kNotFollowed : kSeen;
}

bool is_of(const Teaching& teaching, const FrameId& frame) {
  constexpr std::int64_t kNearlyUs = 250'000;  // an object that is shown slowly is about there still
  const bool same_camera = teaching.frame.channel.empty() || teaching.frame.channel == frame.channel;
  const std::int64_t apart_us = microseconds_between(frame.utime, teaching.frame.utime);
  return same_camera && apart_us <= kNearlyUs && apart_us >= -kNearlyUs;
}

/// Returns a part of the image, made darker for text on it.
cv::Mat darkened(cv::Mat& image, const cv::Rect& area) {
  cv::Mat part = image(area & cv::Rect({}, image.size()));
  if (part.empty()) return part;  // an image of a single row or column of pixels
  cv::Mat ground(part.size(), part.type(), kPanelGround);
  cv::addWeighted(part, 0.25, ground, 0.75, 0.0, part);
  return part;
}

void draw_object(cv::Mat& image, const Teaching& teaching, const Camera& camera) {
  if (teaching.box_px) cv::rectangle(image, cv::Rect(*teaching.box_px), colour_of(teaching.state), 2, cv::LINE_AA);
  ObjectPose pose;
  pose.T_camera_object = teaching.T_camera_object;
  draw_pose(image, pose, {}, camera);
}

/// Returns the rotation of the view from the camera; where its pose is unknown, from the front and a little above.
Eigen::Matrix3f view_of(const Teaching& teaching) {
  if (teaching.T_camera_object) return teaching.T_camera_object->linear().cast<float>();
  const Eigen::Vector3f z = Eigen::Vector3f(1.0F, 0.0F, -0.5F).normalized();
  const Eigen::Vector3f x = z.cross(Eigen::Vector3f::UnitZ()).normalized();
  Eigen::Matrix3f view;
  view << x.transpose(), z.cross(x).transpose(), z.transpose();
  return view;
}

void draw_spheres(cv::Mat& image, const Teaching& teaching) {
  if (teaching.directions.empty()) return;
  const int width = 2 * kSphere_px + 3 * kMargin_px;
  cv::Mat part =
      darkened(image, {image.cols - width - kMargin_px, kMargin_px, width, kSphere_px + 2 * kMargin_px + 2 * kLine_px});
  const Eigen::Matrix3f near = view_of(teaching);
  const Eigen::Matrix3f far = Eigen::AngleAxisf(static_cast<float>(M_PI), Eigen::Vector3f::UnitY()) * near;
  const int top = kMargin_px + kLine_px;
  draw_sphere(part, {kMargin_px, top, kSphere_px, kSphere_px}, teaching.directions, near);
  draw_sphere(part, {2 * kMargin_px + kSphere_px, top, kSphere_px, kSphere_px}, teaching.directions, far);
  draw_text(part, "from here", {kMargin_px + 10, kLine_px - 2}, kPanelText);
  draw_text(part, "from behind", {2 * kMargin_px + kSphere_px + 2, kLine_px - 2}, kPanelText);
  draw_text(part, fmt::format("seen from {} of {}", count_covered(teaching), teaching.directions.size()),
            {kMargin_px + 10, top + kSphere_px + kLine_px - 4}, kPanelText);
}

void draw_words(cv::Mat& image, const Teaching& teaching) {
  constexpr int kBar_px = 4;
  const int height = 2 * kLine_px + kBar_px + 2;
  cv::Mat part = darkened(image, {0, image.rows - height, image.cols, height});
  const cv::Scalar colour = colour_of(teaching.state);
  const std::string counts = fmt::format("{}: {}, {} frames, {} kept", teaching.name, to_string(teaching.state),
                                         teaching.frames, teaching.keyframes);
  draw_text(part, counts, {kMargin_px, kLine_px - 4}, kPanelText, colour);
  draw_text(part, teaching.message, {kMargin_px, 2 * kLine_px - 4}, kPanelText);
  if (!teaching.progress) return;
  const int length = static_cast<int>(std::lround(*teaching.progress * static_cast<float>(part.cols)));
  part(cv::Rect(0, part.rows - kBar_px, length, kBar_px) & cv::Rect({}, part.size())).setTo(colour);
}

}  // namespace

void draw_sphere(cv::Mat& image, const cv::Rect& square, const std::vector<ViewDirection>& directions,
                 const Eigen::Matrix3f& R_view_object) {
  constexpr float kReach = 0.86F;  // fraction of the square's half side, so that points at the rim are drawn whole
  const float radius = 0.5F * static_cast<float>(std::min(square.width, square.height));
  const auto dot = [&](float towards) { return std::max(1, static_cast<int>(radius * (0.07F + 0.07F * towards))); };
  const cv::Point middle(square.x + square.width / 2, square.y + square.height / 2);
  cv::circle(image, middle, static_cast<int>(radius), kUnseen, 1, cv::LINE_AA);
  for (const ViewDirection& direction : directions) {
    const Eigen::Vector3f at = R_view_object * direction.direction;
    if (at.z() > 0.0F) continue;  // away from the camera
    const cv::Point place = middle + cv::Point(static_cast<int>(std::lround(kReach * radius * at.x())),
                                               static_cast<int>(std::lround(kReach * radius * at.y())));
    cv::circle(image, place, dot(-at.z()), direction.seen ? kSeen : kUnseen, cv::FILLED, cv::LINE_AA);
  }
}

void draw_teaching(cv::Mat& image, const Teaching& teaching, const RgbdFrame& frame) {
  if (is_of(teaching, frame.id)) draw_object(image, teaching, frame.camera);
  draw_spheres(image, teaching);
  draw_words(image, teaching);
}

}  // namespace houghstream::view
