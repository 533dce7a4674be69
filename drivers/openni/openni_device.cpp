#include "drivers/openni/openni_device.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "drivers/openni/oni_times.hpp"
#include "drivers/openni/openni_parts.hpp"
#include "drivers/openni/openni_recording.hpp"
#include "drivers/openni/stream_reader.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"

namespace houghstream::openni {
namespace {

using std::chrono::milliseconds;
using Sensor = SensorImage::Sensor;

// The images that a driver may hold when its modes are set, computed as they were before; drivers have three buffers.
constexpr int kDepthBeforeModes = 3;
constexpr milliseconds kFirstImage(1000);  // cameras take that long to start

/// Calls `wait` with parts of `timeout` until it returns something, the patience has run out or a stop is asked for.
template <typename Wait>
auto wait_in_parts(milliseconds timeout, const StopRequested& stop_requested, const Wait& wait) {
  auto result = wait(std::min(timeout, kPollInterval));
  const auto end = std::chrono::steady_clock::now() + timeout - std::min(timeout, kPollInterval);
  while (!result && std::chrono::steady_clock::now() < end && !(stop_requested && stop_requested())) {
    result = wait(kPollInterval);
  }
  return result;
}

/// Reads the first images of a recorded file, whose times are compared with those of the live images; fewer where it is
/// shorter.
FirstImages read_first_images(const std::string& file) {
  const auto device = OpenniDevice::open_file(file);
  constexpr std::size_t kCompared = 24;  // images of a stream: enough where only some were seen live
  FirstImages first;
  while (std::min(first.depth.size(), first.colour.size()) < kCompared && !device->ended()) {
    const std::optional<SensorImage> image = device->wait(kFileTimeout);
    if (image && first.of(image->sensor).size() < kCompared) first.of(image->sensor).push_back(make_thumbnail(*image));
  }
  return first;
}

}  // namespace

std::vector<CameraDescription> list_cameras(bool closely) {
  const OpenniLibrary library;
  ::openni::Array<::openni::DeviceInfo> found;
  ::openni::OpenNI::enumerateDevices(&found);
  std::vector<CameraDescription> cameras;
  for (int i = 0; i < found.getSize(); ++i) {
    CameraDescription& camera = cameras.emplace_back();
    camera.uri = found[i].getUri();
    camera.vendor = found[i].getVendor();
    camera.name = found[i].getName();
    ::openni::Device device;
    if (!closely || device.open(found[i].getUri()) != ::openni::STATUS_OK) continue;
    camera.serial = serial_of(device);
    camera.modes = common_modes(device);
  }
  return cameras;
}

std::shared_ptr<const void> keep_openni_running() {
  return std::make_shared<OpenniLibrary>();
}

// OpenNI2's objects are destroyed in this order: the reader of the streams, the streams' images, the recorder (it and a
// driver that hands over an image would deadlock), the streams, the device.
struct OpenniDevice::State {
  State(const std::string& name, StopRequested stop) : uri(name), stop_requested(std::move(stop)), departure(name) {}

  std::string uri;
  StopRequested stop_requested;
  OpenniLibrary library;
  DisconnectListener departure;
  ::openni::Device device;
  ::openni::VideoStream depth;
  ::openni::VideoStream colour;
  CameraMode mode;
  bool is_file = false;
  int images_left = 0;    // images of a file still to come
  int depth_to_skip = 0;  // before a camera's images are as its modes say
  ImageQueue inbox;
  std::optional<StreamReader> reader;  // reads a camera's images
  std::optional<OpenniRecording> recording;

  ~State() {
    reader.reset();
    depth.stop();
    colour.stop();
    if (recording) recording->stop();
    // The thread that plays a file looks through its streams without a lock; once they stand still, every 10 ms.
    if (is_file) std::this_thread::sleep_for(milliseconds(5));
    depth.destroy();
    colour.destroy();
    device.close();
    if (recording && recording->started()) recording->finish(read_first_images);
  }

  void open() {
    check_openni(device.open(uri.c_str()), uri + (is_file ? ": no whole .oni recording" : ": cannot be opened"));
  }

  void create_streams() {
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kColour}) {
      const char* name = sensor == Sensor::kDepth ? "depth" : "colour";
      require(device.getSensorInfo(openni_type(sensor)) != nullptr, "{}: has no {} sensor", uri, name);
      ::openni::VideoStream& stream = sensor == Sensor::kDepth ? depth : colour;
      check_openni(stream.create(device, openni_type(sensor)), fmt::format("{}: {} stream", uri, name));
    }
  }

  void set_mode(const CameraMode& wanted) {
    const auto depth_mode = find_mode(device, Sensor::kDepth, wanted);
    const auto colour_mode = find_mode(device, Sensor::kColour, wanted);
    require(depth_mode && colour_mode, "{}: no mode {} of depth and colour; it has {}", uri, mode_text(wanted),
            modes_text(common_modes(device)));
    check_openni(depth.setVideoMode(*depth_mode), uri + ": depth mode " + mode_text(wanted));
    check_openni(colour.setVideoMode(*colour_mode), uri + ": colour mode " + mode_text(wanted));
    mode = wanted;
  }

  void set_features(const CameraOptions& options) {
    for (::openni::VideoStream* stream : {&depth, &colour}) {
      if (stream->getMirroringEnabled()) check_openni(stream->setMirroringEnabled(false), uri + ": mirroring off");
    }
    ::openni::CameraSettings* settings = colour.getCameraSettings();
    const bool set = settings != nullptr &&
                     settings->setAutoExposureEnabled(options.auto_exposure) == ::openni::STATUS_OK &&
                     settings->setAutoWhiteBalanceEnabled(options.auto_white_balance) == ::openni::STATUS_OK;
    const bool asked = !options.auto_exposure || !options.auto_white_balance;
    if (asked && !set) log_warning("{}: exposure and white balance cannot be set", uri);
  }

  /// Some drivers take it before the streams run, some only afterwards.
  bool registered() {
    constexpr auto kWanted = ::openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    if (!device.isImageRegistrationModeSupported(kWanted)) return false;
    if (device.getImageRegistrationMode() == kWanted) return true;
    return device.setImageRegistrationMode(kWanted) == ::openni::STATUS_OK &&
           device.getImageRegistrationMode() == kWanted;
  }

  void start() {
    check_openni(depth.start(), uri + ": depth does not start");
    check_openni(colour.start(), uri + ": colour does not start");
  }

  /// Synchronises the sensors. The status is ok whether the driver can or not; the images' times show it. OpenNI2
  /// deletes the objects to which the driver's thread hands images, and makes new ones, so this is done just behind a
  /// colour image, when no other is on its way.
  void synchronise() {
    wait_in_parts(kFirstImage, stop_requested, [&](milliseconds part) {
      ::openni::VideoStream* streams[] = {&colour};
      int ready = 0;
      const auto part_ms = static_cast<int>(part.count());
      return ::openni::OpenNI::waitForAnyStream(streams, 1, &ready, part_ms) == ::openni::STATUS_OK;
    });
    device.setDepthColorSyncEnabled(true);
  }

  /// Waits until images have the requested modes. Depth from before registration has the same size and looks like any
  /// other, so it is recognised by its order. A recording starts behind it.
  void await_modes() {
    inbox.clear();
    depth_to_skip = kDepthBeforeModes;
  }
  std::optional<SensorImage> read_camera(milliseconds timeout) {
    std::optional<SensorImage> image = inbox.take(timeout);
    while (image && depth_to_skip > 0) {
      if (image->sensor == Sensor::kDepth && --depth_to_skip == 0 && recording) recording->start();
      image = inbox.take(timeout);
    }
    return image;
  }

  /// A file waits until it is asked, so nothing is lost; what cannot be read is not waited for a second time.
  std::optional<SensorImage> read_file(milliseconds timeout) {
    if (images_left == 0) return std::nullopt;
    const std::optional<Sensor> sensor =
        wait_in_parts(timeout, stop_requested, [&](milliseconds part) { return wait_for_image(depth, colour, part); });
    if (!sensor && stop_requested && stop_requested()) return std::nullopt;
    require(sensor.has_value(), "{}: no further image, but {} are still to come: {}", uri, images_left,
            "the file is cut or damaged");
    --images_left;
    return read_image(*sensor == Sensor::kDepth ? depth : colour, *sensor);
  }
};

std::unique_ptr<OpenniDevice> OpenniDevice::open_camera(const std::string& uri, const CameraOptions& options,
                                                        const StopRequested& stop_requested) {
  auto state = std::make_unique<State>(uri, stop_requested);
  state->open();
  state->create_streams();
  state->set_mode(options.mode);
  state->set_features(options);
  const bool at_once = options.assume_registered || state->registered();
  state->start();
  state->synchronise();
  state->reader.emplace(state->depth, state->colour, state->inbox);
  require(at_once || state->registered(),
          "{}: cannot register depth to colour; give --assume-registered if its depth comes registered anyhow", uri);
  if (!options.record.empty()) {
    state->recording.emplace(options, state->depth, state->colour);
  }
  state->await_modes();
  return std::unique_ptr<OpenniDevice>(new OpenniDevice(std::move(state)));
}

std::unique_ptr<OpenniDevice> OpenniDevice::open_file(const std::string& file, const StopRequested& stop_requested) {
  check_oni(file);
  auto state = std::make_unique<State>(file, stop_requested);
  state->is_file = true;
  state->open();
  require(state->device.isFile(), "{}: no recording, expected a .oni file", file);
  state->create_streams();
  state->mode = camera_mode_of(state->depth.getVideoMode());
  constexpr int kMaxHz = 1000;
  require(
      state->mode.width >= 1 && state->mode.height >= 1 && state->mode.rate_hz >= 1 && state->mode.rate_hz <= kMaxHz,
      "{}: states a mode of {}, expected pixels and 1 to {} Hz", file, mode_text(state->mode), kMaxHz);
  ::openni::PlaybackControl* control = state->device.getPlaybackControl();
  check_openni(control->setRepeatEnabled(false), file + ": playing once");
  check_openni(control->setSpeed(-1.0F), file + ": playing at our pace");
  state->images_left = control->getNumberOfFrames(state->depth) + control->getNumberOfFrames(state->colour);
  state->start();
  return std::unique_ptr<OpenniDevice>(new OpenniDevice(std::move(state)));
}

OpenniDevice::OpenniDevice(std::unique_ptr<State> state) : state_(std::move(state)) {}
OpenniDevice::~OpenniDevice() = default;

std::optional<SensorImage> OpenniDevice::wait(milliseconds timeout) {
  std::optional<SensorImage> image = state_->is_file ? state_->read_file(timeout) : state_->read_camera(timeout);
  if (!image) return std::nullopt;
  const bool whole = image->image.cols == state_->mode.width && image->image.rows == state_->mode.height;
  if (whole && image->sensor == Sensor::kColour) cv::cvtColor(image->image, image->image, cv::COLOR_RGB2BGR);
  if (whole && state_->recording) state_->recording->note(*image);
  if (whole) return image;
  require(!state_->is_file, "{}: an image of {}x{}, expected {}", state_->uri, image->image.cols, image->image.rows,
          mode_text(state_->mode));
  return std::nullopt;
}

bool OpenniDevice::ended() const {
  return state_->is_file ? state_->images_left == 0 : state_->departure.gone.load();
}

const CameraMode& OpenniDevice::mode() const {
  return state_->mode;
}

Camera OpenniDevice::camera(const CameraOptions& options) const {
  if (!options.camera) return nominal_camera();
  const Camera& camera = *options.camera;
  require(camera.width == mode().width && camera.height == mode().height,
          "--camera is for images of {}x{}, the images are {}", camera.width, camera.height, mode_text(mode()));
  return camera;
}

Camera OpenniDevice::nominal_camera() const {
  const CameraMode& mode = state_->mode;
  const double horizontal = state_->colour.getHorizontalFieldOfView();
  const double vertical = state_->colour.getVerticalFieldOfView();
  require(horizontal > 0.0 && vertical > 0.0 && horizontal < M_PI && vertical < M_PI,
          "{}: fields of view {} and {} radians; give --camera", state_->uri, horizontal, vertical);
  Camera camera{mode.width, mode.height, 0.0, 0.0, 0.5 * (mode.width - 1), 0.5 * (mode.height - 1)};
  camera.fx = 0.5 * mode.width / std::tan(0.5 * horizontal);
  camera.fy = 0.5 * mode.height / std::tan(0.5 * vertical);
  check_camera(camera, state_->uri);
  return camera;
}

}  // namespace houghstream::openni
