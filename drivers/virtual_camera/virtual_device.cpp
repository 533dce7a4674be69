#include "drivers/virtual_camera/virtual_device.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "pipeline/base/host_clock.hpp"

namespace houghstream::virtual_camera {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;

using SteadyTime = std::chrono::steady_clock::time_point;

// Fraction of a period: VGA depth and colour fill a USB 2 cable; late ones come no closer.
constexpr double kTransfer = 0.75;
constexpr double kClockAtOpeningUs = 5e6;  // a device's clock does not start when it is opened
constexpr int kNiceLevel = -10;
constexpr int kColourAhead = 7;  // unsynchronised, a sensor counts its own images

bool is_dropped(int number, int every) {
  return every > 0 && number % every == every - 1;
}

std::chrono::steady_clock::duration milliseconds_of(double ms) {
  return duration_cast<std::chrono::steady_clock::duration>(duration<double, std::milli>(ms));
}

/// Writes the time at which the shutter was due, for measurements of latency, also where a busy machine lets this
/// thread run later.
void note_shutter(const CameraScript& script, int number, std::uint64_t device_us, SteadyTime shutter) {
  if (script.shutter_file.empty()) return;
  std::ofstream(script.shutter_file, std::ios::app) << number << ' ' << device_us << ' ' << utime_of(shutter) << '\n';
}

}  // namespace

VirtualDevice::VirtualDevice(const ScriptWatch& script, const ImagesBySize& images, std::string serial)
    : script_(script), images_(images), serial_(std::move(serial)) {
  const int rate = script.current()->rate_hz;
  sensors_[0].type = ONI_SENSOR_DEPTH;
  sensors_[1].type = ONI_SENSOR_COLOR;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const OniPixelFormat format = i == 0 ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888;
    for (auto size = images.rbegin(); size != images.rend(); ++size) {
      const Camera& camera = size->second.camera;
      sensors_[i].cameras.push_back(camera);
      sensors_[i].modes.push_back({format, camera.width, camera.height, rate});
    }
    infos_[i] = {sensors_[i].type, static_cast<int>(sensors_[i].modes.size()), sensors_[i].modes.data()};
  }
  thread_ = std::thread([this] { run(); });
}

VirtualDevice::~VirtualDevice() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    running_ = false;
  }
  end_.notify_all();
  thread_.join();
}

OniStatus VirtualDevice::getSensorInfoList(OniSensorInfo** infos, int* count) {
  *infos = infos_.data();
  *count = static_cast<int>(infos_.size());
  return ONI_STATUS_OK;
}

oni::driver::StreamBase* VirtualDevice::createStream(OniSensorType type) {
  for (const VirtualSensor& sensor : sensors_) {
    if (sensor.type != type) continue;
    const std::lock_guard<std::mutex> lock(streams_mutex_);
    streams_.push_back(std::make_shared<VirtualStream>(*this, sensor));
    return streams_.back().get();
  }
  return nullptr;
}

void VirtualDevice::destroyStream(oni::driver::StreamBase* stream) {
  const std::lock_guard<std::mutex> lock(streams_mutex_);
  const auto is_it = [&](const std::shared_ptr<VirtualStream>& known) { return known.get() == stream; };
  streams_.erase(std::remove_if(streams_.begin(), streams_.end(), is_it), streams_.end());
}

OniBool VirtualDevice::isPropertySupported(int property) {
  return property == ONI_DEVICE_PROPERTY_SERIAL_NUMBER || property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION;
}

OniStatus VirtualDevice::getProperty(int property, void* data, int* size) {
  if (property == ONI_DEVICE_PROPERTY_SERIAL_NUMBER && *size > static_cast<int>(serial_.size())) {
    std::memcpy(data, serial_.c_str(), serial_.size() + 1);
    *size = static_cast<int>(serial_.size() + 1);
    return ONI_STATUS_OK;
  }
  if (property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION && *size == sizeof(OniImageRegistrationMode)) {
    const auto mode = registered_ ? ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR : ONI_IMAGE_REGISTRATION_OFF;
    std::memcpy(data, &mode, sizeof(OniImageRegistrationMode));
    return ONI_STATUS_OK;
  }
  return ONI_STATUS_NOT_SUPPORTED;
}

OniStatus VirtualDevice::setProperty(int property, const void* data, int size) {
  OniImageRegistrationMode mode = ONI_IMAGE_REGISTRATION_OFF;
  if (property != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_SUPPORTED;
  if (size != sizeof(mode)) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(&mode, data, sizeof(mode));
  return set_registration(mode);
}

OniStatus VirtualDevice::set_registration(OniImageRegistrationMode mode) {
  if (!isImageRegistrationModeSupported(mode)) return ONI_STATUS_NOT_SUPPORTED;
  const ScriptWatch::Script script = script_.current();
  const auto known = streams();
  const bool running = std::any_of(known.begin(), known.end(), [](const auto& stream) { return stream->is_running(); });
  if (script->registers_running && !running) return ONI_STATUS_OUT_OF_FLOW;
  unregistered_left_ = script->register_late;
  registered_ = mode == ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR;
  return ONI_STATUS_OK;
}

bool VirtualDevice::is_registered_by_now() {
  if (!registered_) return false;
  if (unregistered_left_ == 0) return true;
  --unregistered_left_;
  return false;
}

OniBool VirtualDevice::isImageRegistrationModeSupported(OniImageRegistrationMode mode) {
  return mode == ONI_IMAGE_REGISTRATION_OFF || script_.current()->can_register;
}

bool VirtualDevice::synchronise() {
  synchronised_ = script_.current()->can_sync;
  return synchronised_;
}

void VirtualDevice::run() {
  setpriority(PRIO_PROCESS, 0, kNiceLevel);  // of this thread, where the rights allow: a real camera waits for nobody
  std::unique_lock<std::mutex> lock(mutex_);
  Clock::time_point shutter = start_;
  Clock::time_point cable_free = start_;
  for (int number = 0; running_;) {
    Clock::time_point due = std::max(shutter, cable_free);
    if (!late_.empty()) due = std::min(due, late_.front().due);
    if (end_.wait_until(lock, due, [&] { return !running_; })) return;
    lock.unlock();
    const Clock::time_point now = Clock::now();
    send_late_colour(now);
    if (now >= shutter && now >= cable_free) {
      open_shutters(number++, shutter);
      const double period_ms = 1e3 / script_.current()->rate_hz;
      cable_free = Clock::now() + milliseconds_of(kTransfer * period_ms);
      shutter += milliseconds_of(period_ms);
    }
    lock.lock();
  }
}

void VirtualDevice::open_shutters(int number, Clock::time_point now) {
  const ScriptWatch::Script script = script_.current();
  if (!script->plugged) {
    late_.clear();
    return;
  }
  const double phase_ms = synchronised_ ? 0.0 : script->colour_phase_ms;
  const Clock::time_point colour_time = now + milliseconds_of(phase_ms);
  const std::uint64_t device_us = device_time_us(now, *script);
  for (const auto& stream : streams()) {
    const OniVideoMode mode = stream->mode();
    const std::vector<CameraImage>& images = images_.at({mode.resolutionX, mode.resolutionY}).images;
    const CameraImage& image = images[static_cast<std::size_t>(number) % images.size()];
    if (stream->type() == ONI_SENSOR_COLOR) {
      if (is_dropped(number, script->drop_colour_every)) continue;
      late_.push_back({colour_time + milliseconds_of(script->colour_late_ms),
                       number + (synchronised_ ? 0 : kColourAhead), device_time_us(colour_time, *script),
                       image.colour});
    } else if (!is_dropped(number, script->drop_depth_every)) {
      if (!stream->is_running()) continue;
      stream->send(is_registered_by_now() ? image.depth_mm : unregistered(image.depth_mm), number, device_us);
    }
  }
  send_late_colour(Clock::now());
  note_shutter(*script, number, device_us, now);  // last: the disk may keep it waiting
}

/// Returns a copy, since OpenNI2 may destroy a stream while another thread of it waits for an image to be accepted.
std::vector<std::shared_ptr<VirtualStream>> VirtualDevice::streams() {
  const std::lock_guard<std::mutex> lock(streams_mutex_);
  return streams_;
}

void VirtualDevice::send_late_colour(Clock::time_point now) {
  while (!late_.empty() && late_.front().due <= now) {
    const LateColour late = std::move(late_.front());
    late_.pop_front();
    for (const auto& stream : streams()) {
      if (stream->type() == ONI_SENSOR_COLOR) stream->send(late.image, late.number, late.device_us);
    }
  }
}

std::uint64_t VirtualDevice::device_time_us(Clock::time_point time, const CameraScript& script) const {
  const double elapsed_us = duration<double, std::micro>(time - start_).count();
  const double device_us =
      kClockAtOpeningUs + elapsed_us * (1.0 + 1e-6 * script.clock_drift_ppm) + 1e3 * script.clock_ahead_ms;
  return static_cast<std::uint64_t>(std::llround(std::max(device_us, 0.0)));
}

cv::Mat VirtualDevice::unregistered(const cv::Mat& depth_mm) const {
  const int shift = kParallaxPx * depth_mm.cols / 640;
  cv::Mat beside(depth_mm.size(), CV_16UC1, cv::Scalar(0));
  depth_mm.colRange(0, depth_mm.cols - shift).copyTo(beside.colRange(shift, depth_mm.cols));
  return beside;
}

}  // namespace houghstream::virtual_camera
