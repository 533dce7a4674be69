#include "drivers/openni/camera_choice.hpp"

#include <algorithm>
#include <charconv>

#include "pipeline/base/checks.hpp"

namespace houghstream::openni {
namespace {

/// Returns the number in "#2".
std::size_t index_of(const std::string& selector) {
  std::size_t index = 0;
  const char* end = selector.data() + selector.size();
  const auto [stop, error] = std::from_chars(selector.data() + 1, end, index);
  require(error == std::errc() && stop == end && index > 0, "camera '{}', expected # and a number from 1", selector);
  return index;
}

}  // namespace

const CameraDescription& choose_camera(const std::vector<CameraDescription>& cameras, const std::string& selector) {
  require(!cameras.empty(), "no camera found: is it plugged in, and is its OpenNI2 driver installed?");
  if (selector.empty()) return cameras.front();
  if (selector.front() == '#') {
    const std::size_t index = index_of(selector);
    require(index <= cameras.size(), "camera {} is not there; found:\n{}", selector, cameras_text(cameras));
    return cameras[index - 1];
  }
  const auto found = std::find_if(cameras.begin(), cameras.end(), [&](const CameraDescription& camera) {
    return camera.uri == selector || camera.serial == selector;
  });
  require(found != cameras.end(), "no camera has the URI or serial number '{}'; found:\n{}", selector,
          cameras_text(cameras));
  return *found;
}

std::string cameras_text(const std::vector<CameraDescription>& cameras) {
  std::string text;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const CameraDescription& camera = cameras[i];
    text += fmt::format("{}#{} {} {}, uri {}", i == 0 ? "" : "\n", i + 1, camera.vendor, camera.name, camera.uri);
    if (!camera.serial.empty()) text += ", serial " + camera.serial;
    if (!camera.modes.empty()) text += ", modes " + modes_text(camera.modes);
  }
  return text;
}

}  // namespace houghstream::openni
