#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "drivers/virtual_camera/camera_script.hpp"

namespace houghstream::virtual_camera {

/// Reads the script again whenever its file has changed, in a thread of its own.
class ScriptWatch {
 public:
  using Script = std::shared_ptr<const CameraScript>;

  /// Reads the script. Without a file (an empty path) there is nothing to watch. Throws InputError where it cannot be
  /// read.
  explicit ScriptWatch(std::filesystem::path file);
  ~ScriptWatch();
  ScriptWatch(const ScriptWatch&) = delete;
  ScriptWatch& operator=(const ScriptWatch&) = delete;

  Script current() const;

  /// Makes the watching thread call `changed` with the script before and after each change from now on.
  void start(std::function<void(const CameraScript& before, const CameraScript& after)> changed);

 private:
  void watch();
  void look();

  std::filesystem::path file_;
  std::string text_;  // text of the last poll
  mutable std::mutex mutex_;
  Script script_;
  std::function<void(const CameraScript&, const CameraScript&)> changed_;
  std::atomic<bool> running_{true};
  std::thread thread_;
};

}  // namespace houghstream::virtual_camera
