#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/openni/camera_source.hpp"
#include "drivers/openni/openni_device.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream::openni {
namespace {

class OniSource : public FrameSource {
 public:
  OniSource(const std::string& file, const CameraOptions& options, StopRequested stop_requested)
      : file_(file),
        stop_requested_(std::move(stop_requested)),
        device_(OpenniDevice::open_file(file, stop_requested_)),
        camera_(device_->camera(options)),
        pairing_(pairing_tolerance_us(device_->mode())) {}

  std::optional<RgbdFrame> next() override {
    while (!device_->ended() && !(stop_requested_ && stop_requested_())) {
      std::optional<SensorImage> image = device_->wait(kFileTimeout);
      if (!image) continue;
      require(image->device_us <= kLatestUs, "{}: an image at {} us, expected at most {}", file_, image->device_us,
              kLatestUs);
      const std::optional<ImagePair> pair = pairing_.put(std::move(*image));
      if (pair) return frame_of_pair(*pair, camera_, utime_of(*pair));
    }
    return std::nullopt;
  }

  double rate_hz() const override { return device_->mode().rate_hz; }

 private:
  static constexpr std::uint64_t kLatestUs = 1'000'000'000'000'000;  // thirty years: times are added and compared

  static std::int64_t utime_of(const ImagePair& pair) {
    return dataset_utime(0) + static_cast<std::int64_t>(pair.depth.device_us);
  }

  std::string file_;
  StopRequested stop_requested_;
  std::unique_ptr<OpenniDevice> device_;
  Camera camera_;
  TimestampPairing pairing_;
};

}  // namespace

std::unique_ptr<FrameSource> open_oni_source(const std::string& file, const CameraOptions& options,
                                             const StopRequested& stop_requested) {
  return std::make_unique<OniSource>(file, options, stop_requested);
}

}  // namespace houghstream::openni
