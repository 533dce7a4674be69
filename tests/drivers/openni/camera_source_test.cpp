#include "drivers/openni/camera_source.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include "drivers/openni/timestamp_pairing.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/host_clock.hpp"
#include "tests/drivers/openni/virtual_camera.hpp"
#include "tests/test_files.hpp"

namespace houghstream::openni {
namespace {

using Clock = std::chrono::steady_clock;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Ends a test that would wait for ever.
CameraListener patient_listener(int seconds) {
  const Clock::time_point end = Clock::now() + std::chrono::seconds(seconds);
  return {[end] { return Clock::now() > end; }, {}, {}};
}

double error_px(const RgbdFrame& frame) {
  return disc_error_px(frame.colour, depth_to_millimetres(frame.depth));
}

TEST(CameraSource, ACameraThatIsNotThereOrLacksTheModeIsAnError) {
  const VirtualCamera camera("mode", "serial AA01\nsize 640x480\nsize 320x240\n");
  CameraOptions options;
  options.mode = {1280, 1024, 30};
  const std::string no_mode = error_of([&] { open_camera_source("AA01", options, {}); });
  EXPECT_TRUE(contains(no_mode, "1280x1024@30") && contains(no_mode, "640x480@30, 320x240@30")) << no_mode;
  const std::string no_camera = error_of([&] { open_camera_source("#2", CameraOptions{}, {}); });
  EXPECT_TRUE(contains(no_camera, "houghstream-virtual://1")) << no_camera;
  camera.change("plugged no");
  EXPECT_TRUE(contains(error_of([&] { open_camera_source("", CameraOptions{}, {}); }), "no camera found"));
}

TEST(CameraSource, FramesAreRegisteredNotMirroredAndCarryTheCamera) {
  const VirtualCamera camera("frames", "size 320x240\n");
  CameraOptions options;
  options.mode = {320, 240, 30};
  const auto source = open_camera_source("", options, patient_listener(20));
  EXPECT_TRUE(source->is_live());
  EXPECT_EQ(source->rate_hz(), 30.0);
  const RgbdFrame frame = source->next().value();
  check_frame(frame, "virtual camera");
  EXPECT_NEAR(frame.camera.fx, 525.0 / 2, 1e-3);
  EXPECT_NEAR(frame.camera.cx, 159.5, 1e-9);
  const virtual_camera::CameraImages pattern = virtual_camera::make_test_pattern(frame.camera);
  cv::Mat rgb;
  cv::cvtColor(frame.colour, rgb, cv::COLOR_BGR2RGB);
  int alike = 0;
  for (const virtual_camera::CameraImage& expected : pattern.images) {
    alike += cv::norm(rgb, expected.colour, cv::NORM_INF) == 0 &&
             cv::norm(depth_to_millimetres(frame.depth), expected.depth_mm, cv::NORM_INF) == 0;
  }
  EXPECT_EQ(alike, 1) << "one of the pattern's pictures, colour and depth, bit by bit";
}

TEST(CameraSource, UnregisteredDepthIsRefusedUnlessToldOtherwise) {
  const VirtualCamera camera("registration", "can_register no\n");
  CameraOptions options;
  EXPECT_TRUE(contains(error_of([&] { open_camera_source("", options, {}); }), "--assume-registered"));
  options.assume_registered = true;
  const RgbdFrame frame = open_camera_source("", options, patient_listener(20))->next().value();
  EXPECT_NEAR(error_px(frame), 20.0, 1.0) << "the virtual camera's parallax: what registration takes away";
}

TEST(CameraSource, DepthFromBeforeItsRegistrationIsNotUsed) {
  for (const char* script : {"register_late 2\n", "register_late 2\nregisters_running yes\n"}) {
    const VirtualCamera camera("before", script);
    const auto source = open_camera_source("", CameraOptions{}, patient_listener(20));
    for (int i = 0; i < 10; ++i) EXPECT_LT(error_px(source->next().value()), 0.5) << script << i;
  }
}

TEST(CameraSource, ACalibrationMustBeOfTheMode) {
  const VirtualCamera camera("calibration", "");
  CameraOptions options;
  options.camera = Camera{640, 480, 530.0, 531.0, 310.0, 250.0};
  EXPECT_TRUE(open_camera_source("", options, patient_listener(20))->next()->camera == *options.camera);
  options.camera = Camera{320, 240, 265.0, 265.0, 160.0, 120.0};
  EXPECT_TRUE(contains(error_of([&] { open_camera_source("", options, {}); }), "320x240"));
}

/// Returns the frames that the naive way would make: each depth image with the last colour image that has arrived.
double mean_error_of_last_colour() {
  const auto running = keep_openni_running();
  const auto device = OpenniDevice::open_camera("houghstream-virtual://1", CameraOptions{});
  cv::Mat colour;
  double sum = 0.0;
  int count = 0;
  while (count < 30) {
    const std::optional<SensorImage> image = device->wait(std::chrono::seconds(5));
    if (!image) return -1.0;
    if (image->sensor == SensorImage::Sensor::kColour) {
      colour = image->image;
    } else if (!colour.empty()) {
      sum += disc_error_px(colour, image->image);
      ++count;
    }
  }
  return sum / count;
}

TEST(CameraSource, LateAndUnsynchronisedColourMeetsItsOwnDepth) {
  const VirtualCamera camera("late", "can_sync no\ncolour_phase_ms 8\ncolour_late_ms 70\n");
  EXPECT_GT(mean_error_of_last_colour(), 20.0) << "the last colour lies beside the depth: the test can tell";
  const auto source = open_camera_source("", CameraOptions{}, patient_listener(20));
  for (int i = 0; i < 60; ++i) {
    const std::optional<RgbdFrame> frame = source->next();
    ASSERT_TRUE(frame.has_value());
    EXPECT_LT(error_px(*frame), 0.5) << i;
  }
}

TEST(CameraSource, LostColourCostsItsFrameOnly) {
  for (const char* sync : {"yes", "no"}) {
    const VirtualCamera camera("lost", std::string("drop_colour_every 5\ncan_sync ") + sync + "\n");
    std::vector<std::int64_t> numbers;
    CameraListener listener = patient_listener(20);
    listener.on_depth_number = [&](std::int64_t number) { numbers.push_back(number); };
    const auto source = open_camera_source("", CameraOptions{}, listener);
    for (int i = 0; i < 40; ++i) {
      const std::optional<RgbdFrame> frame = source->next();
      ASSERT_TRUE(frame.has_value());
      EXPECT_LT(error_px(*frame), 0.5) << i;
    }
    for (const std::int64_t number : numbers) EXPECT_NE(number % 5, 4) << "its colour was lost";
    EXPECT_GE(numbers.back() - numbers.front() + 1, 40 + 40 / 5 - 1);
  }
}

TEST(CameraSource, AnUnpluggedCameraIsWaitedFor) {
  const VirtualCamera camera("replug", "serial AA01\nserial AA02\n");
  std::vector<std::string> words;
  CameraListener listener = patient_listener(30);
  listener.on_error = [&](const std::string& reason) { words.push_back(reason); };
  const auto source = open_camera_source("AA02", CameraOptions{}, listener);
  std::int64_t last = source->next()->id.utime;
  Clock::time_point replugged;
  std::thread hand([&] {
    camera.change("serial AA01\nserial AA02\nplugged no\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    replugged = Clock::now();
    camera.change("serial AA01\nserial AA02\n");
  });
  std::int64_t gap = 0;
  while (words.size() < 2) {
    const std::optional<RgbdFrame> frame = source->next();
    ASSERT_TRUE(frame.has_value());
    gap = std::max(gap, frame->id.utime - last);
    last = frame->id.utime;
  }
  const Clock::time_point back = Clock::now();
  hand.join();
  const double took = std::chrono::duration<double>(back - replugged).count();
  RecordProperty("reconnect_ms", static_cast<int>(1e3 * took));
  std::printf("frames are back %.0f ms after the camera\n", 1e3 * took);
  EXPECT_LT(took, 2.0);
  EXPECT_GT(gap, 500'000) << "utimes show the gap";
  EXPECT_TRUE(contains(words[0], "houghstream-virtual://2: the camera is gone")) << words[0];
  EXPECT_TRUE(contains(words[1], "back, was away for")) << words[1];
}

TEST(CameraSource, AJumpOfTheDevicesClockDoesNotShow) {
  for (const char* jump : {"clock_ahead_ms 2500\n", "clock_ahead_ms -2500\n"}) {
    const VirtualCamera camera("jump", "can_sync no\n");
    const auto source = open_camera_source("", CameraOptions{}, patient_listener(20));
    std::int64_t last = 0;
    for (int i = 0; i < 60; ++i) {
      if (i == 20) camera.change(std::string("can_sync no\n") + jump);
      const RgbdFrame frame = source->next().value();
      EXPECT_LT(error_px(frame), 0.5) << i;
      EXPECT_GT(frame.id.utime, last) << i;
      EXPECT_LE(frame.id.utime, utime_now()) << i;
      EXPECT_GT(frame.id.utime, utime_now() - 1'250'000) << i << ": half of the jump, for a busy machine";
      last = frame.id.utime;
    }
  }
}

TEST(CameraSource, EndsSoonWhenAskedThoughItsColourNeverComes) {
  const VirtualCamera camera("no_colour", "size 320x240\ndrop_colour_every 1\n");
  CameraOptions options;
  options.mode = {320, 240, 30};
  const Clock::time_point start = Clock::now();
  const auto stop = [start] { return Clock::now() > start + std::chrono::milliseconds(100); };
  EXPECT_FALSE(open_camera_source("", options, {stop, {}, {}})->next().has_value());
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - start).count(), 1.0);
}

TEST(CameraSource, EndsWhenAskedThoughNoCameraIsThere) {
  const VirtualCamera camera("stop", "");
  std::atomic<bool> stop = false;
  const auto source = open_camera_source("", CameraOptions{}, {[&] { return stop.load(); }, {}, {}});
  ASSERT_TRUE(source->next().has_value());
  camera.change("plugged no\n");
  std::thread hand([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    stop = true;
  });
  while (source->next().has_value()) {
  }
  hand.join();
  EXPECT_TRUE(stop.load());
}

}  // namespace
}  // namespace houghstream::openni
