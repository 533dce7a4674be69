#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/no_value.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_values.hpp"

namespace houghstream {
namespace {

std::optional<cv::Rect2f> box_from(const teaching_t& message) {
  const cv::Rect2f box(message.box_x, message.box_y, message.box_width, message.box_height);
  if (std::isnan(box.x) && std::isnan(box.y) && std::isnan(box.width) && std::isnan(box.height)) return std::nullopt;
  check_wire_box(box, "box", ", or NaN");
  return box;
}

std::optional<Eigen::Isometry3d> pose_from(const teaching_t& message) {
  const Eigen::Vector3d translation(message.trans);
  const Eigen::Vector4d wxyz(message.quat);
  if (translation.array().isNaN().all() && wxyz.array().isNaN().all()) return std::nullopt;
  return pose_from_wire(message.trans, message.quat, "pose", ", or NaN");
}

ViewDirection direction_from(const std::vector<float>& xyz, std::int8_t seen) {
  const Eigen::Vector3f direction(xyz.at(0), xyz.at(1), xyz.at(2));
  require(std::abs(direction.norm() - 1.0F) < kUnitTolerance, "a direction of length {}, expected 1", direction.norm());
  return {direction, seen != 0};
}

}  // namespace

known_objects_t to_message(const KnownObjects& known) {
  known_objects_t message{};
  message.store = known.store;
  message.since_utime = known.since_utime;
  for (const KnownObject& object : known.objects) {
    message.object_names.push_back(object.name);
    message.object_since_utimes.push_back(object.since_utime);
  }
  message.n_objects = static_cast<std::int32_t>(known.objects.size());
  message.problem = known.problem;
  return message;
}

teaching_t to_message(const Teaching& teaching) {
  teaching_t message{};
  message.utime = teaching.frame.utime;
  message.source_channel = teaching.frame.channel;
  message.name = teaching.name;
  message.state = static_cast<std::int8_t>(teaching.state);
  message.message = teaching.message;
  message.progress = teaching.progress.value_or(kNoValue);
  message.n_frames = teaching.frames;
  message.n_keyframes = teaching.keyframes;
  const cv::Rect2f box = teaching.box_px.value_or(cv::Rect2f(kNoValue, kNoValue, kNoValue, kNoValue));
  message.box_x = box.x;
  message.box_y = box.y;
  message.box_width = box.width;
  message.box_height = box.height;
  std::fill_n(message.trans, 3, std::numeric_limits<double>::quiet_NaN());
  std::fill_n(message.quat, 4, std::numeric_limits<double>::quiet_NaN());
  if (teaching.T_camera_object) {
    const rigid_transform_t transform = to_message(teaching.frame.utime, *teaching.T_camera_object);
    std::copy_n(transform.trans, 3, message.trans);
    std::copy_n(transform.quat, 4, message.quat);
  }
  for (const ViewDirection& direction : teaching.directions) {
    message.directions.push_back({direction.direction.x(), direction.direction.y(), direction.direction.z()});
    message.seen.push_back(direction.seen ? 1 : 0);
  }
  message.n_directions = static_cast<std::int32_t>(teaching.directions.size());
  return message;
}

Teaching teaching_from_message(const teaching_t& message) {
  try {
    require(message.state > teaching_t::INVALID && message.state <= teaching_t::FAILED, "state {}, expected {} to {}",
            message.state, teaching_t::CHOOSING, teaching_t::FAILED);
    require(std::isnan(message.progress) || (message.progress >= 0.0F && message.progress <= 1.0F),
            "progress {}, expected 0 to 1, or NaN", message.progress);
    Teaching out;
    out.frame = {message.source_channel, message.utime};
    out.name = message.name;
    out.state = static_cast<TeachingState>(message.state);
    out.message = message.message;
    if (!std::isnan(message.progress)) out.progress = message.progress;
    out.frames = message.n_frames;
    out.keyframes = message.n_keyframes;
    out.box_px = box_from(message);
    out.T_camera_object = pose_from(message);
    for (std::size_t i = 0; i < message.directions.size(); ++i)
      out.directions.push_back(direction_from(message.directions[i], message.seen.at(i)));
    return out;
  } catch (const InputError& error) {
    fail("teaching of '{}': {}", message.name, error.what());
  }
}

}  // namespace houghstream
