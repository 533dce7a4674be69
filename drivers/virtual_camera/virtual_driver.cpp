#include <cstdio>
#include <cstdlib>
#include <exception>

#include "drivers/virtual_camera/virtual_device.hpp"
#include "pipeline/base/checks.hpp"

// An OpenNI2 driver whose cameras exist in a file only: so that all that happens between a camera and this program can
// be tried, by tests and by people without one. $HOUGHSTREAM_VIRTUAL_CAMERA names the script (camera_script.hpp).

namespace houghstream::virtual_camera {
namespace {

std::string uri_of(std::size_t index) {
  return "houghstream-virtual://" + std::to_string(index + 1);
}

OniDeviceInfo info_of(std::size_t index) {
  OniDeviceInfo info{};
  std::snprintf(info.uri, sizeof(info.uri), "%s", uri_of(index).c_str());
  std::snprintf(info.vendor, sizeof(info.vendor), "Houghstream");
  std::snprintf(info.name, sizeof(info.name), "virtual camera");
  return info;
}

ImagesBySize make_images(const CameraScript& script) {
  ImagesBySize all;
  if (!script.scene.empty()) {
    CameraImages scene = load_scene_images(script.scene);
    const std::pair<int, int> size(scene.camera.width, scene.camera.height);
    all.emplace(size, std::move(scene));
    return all;
  }
  for (const Camera& camera : script.sizes) {
    all.emplace(std::pair(camera.width, camera.height), make_test_pattern(camera));
  }
  return all;
}

class VirtualDriver : public oni::driver::DriverBase {
 public:
  explicit VirtualDriver(OniDriverServices* services) : DriverBase(services) {}

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    const char* value = std::getenv("HOUGHSTREAM_VIRTUAL_CAMERA");
    const std::filesystem::path file = value != nullptr ? value : "";
    return guarded([&] {
      // OpenNI2 changes to the drivers' folder when it loads them, so that a relative path would lead elsewhere.
      require(file.empty() || file.is_absolute(), "{}: HOUGHSTREAM_VIRTUAL_CAMERA, expected an absolute path",
              file.string());
      watch_ = std::make_unique<ScriptWatch>(file);
      serials_ = watch_->current()->serials;
      if (watch_->current()->plugged) plug();
      watch_->start([this](const CameraScript& before, const CameraScript& after) {
        if (before.plugged != after.plugged) after.plugged ? plug() : unplug();
      });
    });
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override {
    oni::driver::DeviceBase* device = nullptr;
    guarded([&] {
      for (std::size_t i = 0; i < serials_.size(); ++i) {
        if (uri_of(i) != uri) continue;
        if (images_.empty()) images_ = make_images(*watch_->current());
        device = new VirtualDevice(*watch_, images_, serials_[i]);
      }
    });
    return device;
  }

  void deviceClose(oni::driver::DeviceBase* device) override { delete static_cast<VirtualDevice*>(device); }

  void shutdown() override { watch_.reset(); }

  /// Called by OpenNI2 for the streams of one device.
  void* enableFrameSync(oni::driver::StreamBase** streams, int count) override {
    if (count == 0) return nullptr;
    VirtualDevice& device = static_cast<VirtualStream*>(streams[0])->device();
    return device.synchronise() ? &device : nullptr;
  }

  void disableFrameSync(void* device) override { static_cast<VirtualDevice*>(device)->unsynchronise(); }

 private:
  /// No exception may leave the driver. OpenNI2 does not report why a driver did not start, so the reason is printed
  /// too.
  template <typename Work>
  OniStatus guarded(const Work& work) {
    try {
      work();
      return ONI_STATUS_OK;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "virtual camera: %s\n", error.what());
      getServices().errorLoggerAppend("virtual camera: %s", error.what());
      return ONI_STATUS_ERROR;
    }
  }

  void plug() {
    for (std::size_t i = 0; i < serials_.size(); ++i) {
      const OniDeviceInfo info = info_of(i);
      deviceConnected(&info);
    }
  }

  void unplug() {
    for (std::size_t i = 0; i < serials_.size(); ++i) {
      const OniDeviceInfo info = info_of(i);
      deviceDisconnected(&info);
    }
  }

  std::unique_ptr<ScriptWatch> watch_;
  std::vector<std::string> serials_;
  ImagesBySize images_;
};

}  // namespace
}  // namespace houghstream::virtual_camera

ONI_EXPORT_DRIVER(houghstream::virtual_camera::VirtualDriver)
