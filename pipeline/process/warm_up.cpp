#include "pipeline/process/warm_up.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "pipeline/base/stop_signal.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream {

RgbdFrame make_warm_up_frame() {
  RgbdFrame frame;
  frame.camera = {640, 480, 525.0, 525.0, 319.5, 239.5};
  frame.colour.create(frame.camera.height, frame.camera.width, CV_8UC3);
  frame.depth.create(frame.camera.height, frame.camera.width, CV_32FC1);
  for (int y = 0; y < frame.depth.rows; ++y) {
    for (int x = 0; x < frame.depth.cols; ++x) {
      const double wave = std::sin(0.05 * x) * std::cos(0.07 * y);
      frame.depth.at<float>(y, x) = static_cast<float>(1.0 + 0.05 * wave);
      frame.colour.at<cv::Vec3b>(y, x) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                          static_cast<std::uint8_t>(127.0 + 127.0 * wave)};
    }
  }
  return frame_from_message(to_message(frame, WireFormat{}, 0), "", std::nullopt);
}

std::shared_future<RgbdFrame> start_warm_up() {
  const BlockStopSignals block;
  return std::async(std::launch::async, [] {
    cv::Mat pixel(1, 1, CV_8UC3, cv::Scalar(0, 0, 0));
    cv::cvtColor(pixel, pixel, cv::COLOR_BGR2Lab);
    return make_warm_up_frame();
  });
}

int warm_up_threads(int threads_of_work) {
  constexpr int kMax = 8;
  return std::max(threads_of_work, std::min(static_cast<int>(std::thread::hardware_concurrency()), kMax));
}

}  // namespace houghstream
