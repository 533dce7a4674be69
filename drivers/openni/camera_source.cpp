#include "drivers/openni/camera_source.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "drivers/openni/device_clock.hpp"
#include "drivers/openni/openni_device.hpp"
#include "drivers/openni/timestamp_pairing.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"

namespace houghstream::openni {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::chrono::seconds kFrameTimeout(3);  // a camera that gives no frame for so long is taken for gone

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class CameraSource : public FrameSource {
 public:
  CameraSource(std::string selector, CameraOptions options, CameraListener listener)
      : selector_(std::move(selector)),
        options_(std::move(options)),
        listener_(std::move(listener)),
        openni_(keep_openni_running()),
        pairing_(pairing_tolerance_us(options_.mode)) {
    open();
    log_info("{}: {}", uri_, mode_text(options_.mode));
  }

  std::optional<RgbdFrame> next() override {
    while (!stop_requested()) {
      if (!device_ && !try_again()) continue;
      std::optional<SensorImage> image = device_->wait(kPollInterval);
      if (image) {
        const std::optional<ImagePair> pair = pairing_.put(std::move(*image));
        if (pair) return complete(*pair);
      }
      look_after_device(image.has_value());
    }
    return std::nullopt;
  }

  double rate_hz() const override { return options_.mode.rate_hz; }
  bool is_live() const override { return true; }

 private:
  bool stop_requested() const { return listener_.stop_requested && listener_.stop_requested(); }

  void tell(const std::string& reason) const {
    log_warning("{}", reason);
    if (listener_.on_error) listener_.on_error(reason);
  }

  /// A serial number needs a closer look, which opens the cameras; a URI or number does not.
  std::string find_uri() const {
    std::vector<CameraDescription> cameras = list_cameras(false);
    const bool needs_serial = !selector_.empty() && selector_.front() != '#' &&
                              std::none_of(cameras.begin(), cameras.end(),
                                           [&](const CameraDescription& camera) { return camera.uri == selector_; });
    if (needs_serial) cameras = list_cameras(true);
    return choose_camera(cameras, selector_).uri;
  }

  void open() {
    uri_ = find_uri();
    CameraOptions options = options_;
    options.replace_record = options.replace_record && !has_recorded_;
    device_ = OpenniDevice::open_camera(uri_, options, listener_.stop_requested);
    has_recorded_ = true;
    camera_ = device_->camera(options_);
    pairing_.clear();
    clock_.restart();
    last_frame_ = Clock::now();
  }

  /// Opens the camera if it is there again; false where it is not, after a little while.
  bool try_again() {
    try {
      open();
      return true;
    } catch (const InputError& error) {
      log_debug("{}", error.what());
    }
    std::this_thread::sleep_for(kPollInterval);
    return false;
  }

  RgbdFrame complete(const ImagePair& pair) {
    if (listener_.on_depth_number) listener_.on_depth_number(pair.depth.number);
    if (!std::exchange(told_distance_, true)) {
      const double apart_us = static_cast<double>(pair.colour.device_us) - static_cast<double>(pair.depth.device_us);
      log_info("{}: colour is taken {:.1f} ms after depth", uri_, 1e-3 * apart_us);
    }
    last_frame_ = Clock::now();
    if (gone_since_) {
      tell(fmt::format("{}: back, was away for {:.2f} s", uri_, seconds_since(*gone_since_)));
      gone_since_.reset();
    }
    return frame_of_pair(pair, camera_, clock_.utime(pair.depth.device_us, pair.depth.host_us));
  }

  void look_after_device(bool alive) {
    const bool gone = device_->ended() && !alive;
    const bool silent = seconds_since(last_frame_) > std::chrono::duration<double>(kFrameTimeout).count();
    if (!gone && !silent) return;
    if (!gone_since_) gone_since_ = last_frame_;
    tell(gone ? fmt::format("{}: the camera is gone; waiting for it", uri_)
              : fmt::format("{}: no frame for {} s ({} depth images without colour so far); opening it again", uri_,
                            kFrameTimeout.count(), pairing_.unpaired()));
    device_.reset();
  }

  std::string selector_;
  CameraOptions options_;
  CameraListener listener_;
  std::shared_ptr<const void> openni_;
  TimestampPairing pairing_;
  DeviceClock clock_;
  std::string uri_;
  std::unique_ptr<OpenniDevice> device_;
  Camera camera_;
  bool has_recorded_ = false;
  bool told_distance_ = false;
  Clock::time_point last_frame_;
  std::optional<Clock::time_point> gone_since_;
};

}  // namespace

std::unique_ptr<FrameSource> open_camera_source(const std::string& selector, const CameraOptions& options,
                                                const CameraListener& listener) {
  return std::make_unique<CameraSource>(selector, options, listener);
}

}  // namespace houghstream::openni
