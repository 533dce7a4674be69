#include "pipeline/types/frame.hpp"

#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/no_value.hpp"

namespace houghstream {

cv::Mat depth_from_millimetres(const cv::Mat& depth_mm) {
  require(depth_mm.type() == CV_16UC1, "depth image of OpenCV type {}, expected 16-bit single channel",
          depth_mm.type());
  cv::Mat depth(depth_mm.size(), CV_32FC1);
  for (int y = 0; y < depth.rows; ++y) {
    const auto* in = depth_mm.ptr<std::uint16_t>(y);
    auto* out = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) out[x] = in[x] == 0 ? kNoValue : static_cast<float>(in[x]) * 1e-3F;
  }
  return depth;
}

cv::Mat depth_to_millimetres(const cv::Mat& depth) {
  require(depth.type() == CV_32FC1, "depth image of OpenCV type {}, expected 32-bit float single channel",
          depth.type());
  cv::Mat depth_mm(depth.size(), CV_16UC1);
  for (int y = 0; y < depth.rows; ++y) {
    const auto* in = depth.ptr<float>(y);
    auto* out = depth_mm.ptr<std::uint16_t>(y);
    for (int x = 0; x < depth.cols; ++x) {
      const float mm = in[x] * 1e3F;
      const bool representable = mm >= 0.5F && mm < 65535.5F;  // false for NaN
      out[x] = representable ? static_cast<std::uint16_t>(std::lround(mm)) : std::uint16_t{0};
    }
  }
  return depth_mm;
}

void check_frame(const RgbdFrame& frame, const std::string& source) {
  check_camera(frame.camera, source);
  require(frame.colour.type() == CV_8UC3, "{}: colour of OpenCV type {}, expected 8-bit BGR", source,
          frame.colour.type());
  require(frame.depth.type() == CV_32FC1, "{}: depth of OpenCV type {}, expected 32-bit float", source,
          frame.depth.type());
  require(frame.colour.size() == frame.depth.size(), "{}: colour {}x{} and depth {}x{}, expected equal sizes", source,
          frame.colour.cols, frame.colour.rows, frame.depth.cols, frame.depth.rows);
  require(frame.colour.cols == frame.camera.width && frame.colour.rows == frame.camera.height,
          "{}: image {}x{} and camera {}x{}, expected equal sizes", source, frame.colour.cols, frame.colour.rows,
          frame.camera.width, frame.camera.height);
}

}  // namespace houghstream
