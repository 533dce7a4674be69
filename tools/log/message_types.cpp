#include "tools/log/message_types.hpp"

#include <fmt/format.h>

#include <houghstream/camera_colours_t.hpp>
#include <houghstream/camera_timing_t.hpp>
#include <houghstream/detections_t.hpp>
#include <houghstream/drake_image_array_t.hpp>
#include <houghstream/drake_viewer_draw_t.hpp>
#include <houghstream/drake_viewer_load_robot_t.hpp>
#include <houghstream/image_t.hpp>
#include <houghstream/images_t.hpp>
#include <houghstream/kinect_frame_msg_t.hpp>
#include <houghstream/known_objects_t.hpp>
#include <houghstream/object_poses_t.hpp>
#include <houghstream/objects_t.hpp>
#include <houghstream/placed_objects_t.hpp>
#include <houghstream/pose_probabilities_t.hpp>
#include <houghstream/pose_t.hpp>
#include <houghstream/rigid_transform_t.hpp>
#include <houghstream/status_t.hpp>
#include <houghstream/teaching_t.hpp>
#include <map>

namespace houghstream::log_tools {

std::int64_t fingerprint_of(ByteView message) {
  if (message.size < 8) return 0;
  return WireReader(message, "message").read_int64();
}

std::string type_name(std::int64_t fingerprint) {
  static const std::map<std::int64_t, std::string> names = {
      {images_t::getHash(), "images_t (bot_core)"},
      {image_t::getHash(), "image_t (bot_core)"},
      {rigid_transform_t::getHash(), "rigid_transform_t (bot_core)"},
      {pose_t::getHash(), "pose_t (bot_core)"},
      {kinect_frame_msg_t::getHash(), "frame_msg_t (kinect)"},
      {drake_image_array_t::getHash(), "lcmt_image_array (drake)"},
      {drake_viewer_load_robot_t::getHash(), "lcmt_viewer_load_robot (drake)"},
      {drake_viewer_draw_t::getHash(), "lcmt_viewer_draw (drake)"},
      {detections_t::getHash(), "detections_t"},
      {object_poses_t::getHash(), "object_poses_t"},
      {pose_probabilities_t::getHash(), "pose_probabilities_t"},
      {camera_colours_t::getHash(), "camera_colours_t"},
      {camera_timing_t::getHash(), "camera_timing_t"},
      {objects_t::getHash(), "objects_t"},
      {placed_objects_t::getHash(), "placed_objects_t"},
      {status_t::getHash(), "status_t"},
      {known_objects_t::getHash(), "known_objects_t"},
      {teaching_t::getHash(), "teaching_t"},
      {0x6c636d2073656c66, "LCM's own test"},  // the text "lcm self test"
  };
  if (fingerprint == 0) return "no message";
  const auto known = names.find(fingerprint);
  return known != names.end() ? known->second : fmt::format("?? {:016x}", static_cast<std::uint64_t>(fingerprint));
}

bool is_frame_type(std::int64_t fingerprint) {
  return fingerprint == images_t::getHash() || fingerprint == kinect_frame_msg_t::getHash() ||
         fingerprint == drake_image_array_t::getHash();
}

}  // namespace houghstream::log_tools
