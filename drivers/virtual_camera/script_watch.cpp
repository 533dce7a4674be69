#include "drivers/virtual_camera/script_watch.hpp"

#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <utility>

namespace houghstream::virtual_camera {
namespace {

constexpr std::chrono::milliseconds kPeriod(10);

/// Two changes may come within a tick of the clock that stamps files, so the text itself is compared.
std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

ScriptWatch::ScriptWatch(std::filesystem::path file)
    : file_(std::move(file)),
      text_(text_of(file_)),
      script_(std::make_shared<CameraScript>(read_camera_script(file_))) {}

ScriptWatch::~ScriptWatch() {
  running_ = false;
  if (thread_.joinable()) thread_.join();
}

ScriptWatch::Script ScriptWatch::current() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return script_;
}

void ScriptWatch::start(std::function<void(const CameraScript&, const CameraScript&)> changed) {
  changed_ = std::move(changed);
  if (!file_.empty()) thread_ = std::thread([this] { watch(); });
}

void ScriptWatch::watch() {
  while (running_) {
    std::this_thread::sleep_for(kPeriod);
    std::string text = text_of(file_);
    if (text == text_) continue;
    text_ = std::move(text);
    look();
  }
}

/// Reads the script again. One that cannot be read leaves the camera as it is, since a driver has no caller that
/// handles errors.
void ScriptWatch::look() {
  try {
    const Script after = std::make_shared<CameraScript>(read_camera_script(file_));
    const Script before = current();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      script_ = after;
    }
    changed_(*before, *after);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "virtual camera: %s\n", error.what());
  }
}

}  // namespace houghstream::virtual_camera
