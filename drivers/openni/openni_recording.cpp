#include "drivers/openni/openni_recording.hpp"

#include <spdlog/spdlog.h>

#include <cstdlib>
#include <fstream>

#include "drivers/openni/oni_times.hpp"
#include "drivers/openni/openni_device.hpp"
#include "drivers/openni/openni_parts.hpp"
#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

using Sensor = SensorImage::Sensor;

constexpr std::size_t kRemembered = 300;  // ten seconds: as late as a sleeping disk may let the recorder begin
constexpr std::size_t kCompared = 8;      // recorded images of a stream
constexpr std::chrono::seconds kPatience(5);

/// The first images of a stream; fewer where a recording is shorter.
std::vector<Remembered> first_recorded(const std::string& file, Sensor sensor) {
  const auto device = OpenniDevice::open_file(file);
  std::vector<Remembered> first;
  while (first.size() < kCompared && !device->ended()) {
    const std::optional<SensorImage> image = device->wait(kPatience);
    if (image && image->sensor == sensor) first.push_back(remember(*image));
  }
  return first;
}

std::int64_t device_start_us(const std::string& file, Sensor sensor, const std::vector<Remembered>& live, bool loses) {
  const std::optional<RecordedStart> start = find_recorded_start(first_recorded(file, sensor), live);
  require(start && (loses || start->difference == 0.0), "{}: its first {} images are not among those seen", file,
          sensor == Sensor::kDepth ? "depth" : "colour");
  return start->device_us;
}

}  // namespace

OpenniRecording::OpenniRecording(std::string file, bool jpeg, openni::VideoStream& depth, openni::VideoStream& colour)
    : file_(std::move(file)), jpeg_(jpeg) {
  // OpenNI2 would crash later.
  require(std::ofstream(file_).good(), "{}: cannot be written, expected a place for a recording", file_);
  check_openni(recorder_.create(file_.c_str()), file_ + ": cannot be recorded to");
  check_openni(recorder_.attach(depth, false), file_ + ": depth");
  check_openni(recorder_.attach(colour, jpeg_), file_ + ": colour");
}

void OpenniRecording::start() {
  started_us_ = host_now_us();
  check_openni(recorder_.start(), file_ + ": recording");
}

void OpenniRecording::note(const SensorImage& image) {
  std::vector<Remembered>& own = image.sensor == Sensor::kDepth ? depth_ : colour_;
  const bool may_be_recorded = started() && image.host_us >= started_us_;
  if (may_be_recorded && own.size() < kRemembered) own.push_back(remember(image));
}

void OpenniRecording::mend_times() noexcept {
  try {
    const std::int64_t colour_later_us =
        device_start_us(file_, Sensor::kColour, colour_, jpeg_) - device_start_us(file_, Sensor::kDepth, depth_, false);
    const OniNode later = colour_later_us > 0 ? OniNode::kSecond : OniNode::kFirst;
    if (colour_later_us != 0) delay_oni_node(file_, later, std::abs(colour_later_us));
  } catch (const std::exception& error) {
    spdlog::warn("{}; in the recording colour may lie beside its depth", error.what());
  }
}

}  // namespace houghstream
