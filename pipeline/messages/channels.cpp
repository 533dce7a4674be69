#include "pipeline/messages/channels.hpp"

#include <fmt/format.h>

#include "pipeline/base/checks.hpp"

namespace houghstream::channel {
namespace {

constexpr std::size_t kMaxChannelLength = 63;

std::string upper_case(std::string name) {
  for (char& c : name) {
    if (c >= 'a' && c <= 'z') {
      c = static_cast<char>(c - 'a' + 'A');
    } else if (!(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9')) {
      c = '_';
    }
  }
  return name;
}

/// Returns FNV-1a (Fowler, Noll and Vo), folded to 16 bits.
unsigned int short_number(const std::string& text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619U;
  return (hash >> 16U) ^ (hash & 0xFFFFU);
}

}  // namespace

std::string camera_name(const std::string& camera_channel) {
  constexpr std::size_t kMaxLength = 31;
  std::string name = upper_case(camera_channel);
  if (name.size() <= kMaxLength) return name;
  return fmt::format("{}_{:04X}", name.substr(0, kMaxLength - 5), short_number(camera_channel));
}

std::string to_world(const std::string& camera_channel) {
  return camera_name(camera_channel) + "_TO_WORLD";
}

std::string to_camera(const std::string& class_name, const std::string& camera_channel) {
  const std::string suffix = "_TO_" + (camera_channel.empty() ? "CAMERA" : camera_name(camera_channel));
  return upper_case(class_name.substr(0, kMaxChannelLength - suffix.size())) + suffix;
}

std::string object_pose(const std::string& class_name, std::int64_t track_id) {
  const std::string suffix = fmt::format("_{}_POSE", track_id);
  return upper_case(class_name.substr(0, kMaxChannelLength - suffix.size())) + suffix;
}

std::string frame_pose(const std::string& class_name, std::int64_t track_id, const std::string& frame) {
  constexpr std::size_t kMaxFrame = 20;
  const std::string suffix = fmt::format("_{}_{}_POSE", track_id, upper_case(frame.substr(0, kMaxFrame)));
  return upper_case(class_name.substr(0, kMaxChannelLength - suffix.size())) + suffix;
}

void require_name(const std::string& name) {
  require(!name.empty() && name.size() <= kMaxChannelLength, "channel '{}': {} bytes, expected 1 to {}", name,
          name.size(), kMaxChannelLength);
}

}  // namespace houghstream::channel
