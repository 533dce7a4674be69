#include "pipeline/process/warm_up.hpp"

#include <cmath>

#include "pipeline/messages/messages.hpp"

namespace houghstream {

RgbdFrame frame_to_warm_up() {
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

}  // namespace houghstream
