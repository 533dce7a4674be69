#include "pipeline/bus/channels.hpp"

namespace houghstream::channel {

std::string to_camera(const std::string& class_name) {
  const std::string suffix = "_TO_CAMERA";
  constexpr std::size_t kMaxChannelLength = 63;
  std::string name = class_name.substr(0, kMaxChannelLength - suffix.size());
  for (char& c : name) {
    if (c >= 'a' && c <= 'z') {
      c = static_cast<char>(c - 'a' + 'A');
    } else if (!(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9')) {
      c = '_';
    }
  }
  return name + suffix;
}

}  // namespace houghstream::channel
