#include "drivers/virtual_camera/script_watch.hpp"

#include <chrono>
#include <cstdio>
#include <exception>

namespace houghstream {
namespace {

constexpr std::chrono::milliseconds kPeriod(10);

std::filesystem::file_time_type time_of(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::last_write_time(file, error);
}

}  // namespace

ScriptWatch::ScriptWatch(std::filesystem::path file)
    : file_(std::move(file)),
      script_(std::make_shared<CameraScript>(read_camera_script(file_))),
      read_at_(time_of(file_)) {}

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
    if (time_of(file_) == read_at_) continue;
    read_at_ = time_of(file_);
    look();
  }
}

/// A script that cannot be read leaves the camera as it is: a driver has nobody to throw to.
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

}  // namespace houghstream
