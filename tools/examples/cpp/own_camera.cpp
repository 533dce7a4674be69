// Feeds the stream with frames of a camera of one's own: RealSense, Azure Kinect, Orbbec, a simulator. Depth is
// registered to colour first (rs2::align, k4a::transformation, ob::Align do it).
//   own_camera [FRAMES]      here: a grey wall at one metre, and a square that comes nearer
#include <chrono>
#include <cstdlib>
#include <limits>
#include <thread>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"

/// In its place stands what an SDK gives: colour (BGR), depth (16 bits) in its unit, and the colour camera's numbers.
struct SdkFrame {
  cv::Mat colour{480, 640, CV_8UC3, cv::Scalar(128, 128, 128)};
  cv::Mat depth{480, 640, CV_16UC1, cv::Scalar(1000)};
  double depth_unit_m = 1e-3;
};

SdkFrame wait_for_frame(int number) {
  std::this_thread::sleep_for(std::chrono::milliseconds(33));
  SdkFrame frame;
  frame.depth(cv::Rect(270, 190, 100, 100)) = cv::Scalar(900 - number % 300);
  return frame;
}

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : std::numeric_limits<int>::max();
  houghstream::LcmBus bus("");  // $LCM_DEFAULT_URL
  for (int number = 0; number < frames; ++number) {
    const SdkFrame taken = wait_for_frame(number);
    houghstream::RgbdFrame frame;
    frame.id.utime =
        std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
            .count();
    frame.colour = taken.colour;
    taken.depth.convertTo(frame.depth, CV_32F, taken.depth_unit_m);  // metres
    frame.depth.setTo(std::numeric_limits<float>::quiet_NaN(), taken.depth == 0);
    frame.camera = {640, 480, 525.0, 525.0, 319.5, 239.5};
    bus.publish(houghstream::channel::kFrame, to_message(frame, houghstream::WireFormat(), number));
  }
}
