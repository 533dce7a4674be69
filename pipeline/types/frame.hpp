#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/types/camera.hpp"
#include "pipeline/types/frame_id.hpp"
#include "pipeline/types/stage_time.hpp"

namespace houghstream {

/// Holds an RGB-D image pair, with depth registered to colour.
struct RgbdFrame {
  FrameId id;                     ///< its name in every result
  cv::Mat colour;                 ///< CV_8UC3, BGR; empty where depth alone was asked for
  cv::Mat depth;                  ///< CV_32FC1, metres along the optical axis, NaN = none; same size as colour
  Camera camera;                  ///< camera of both images
  std::vector<StageTime> stages;  ///< processing so far
};

/// Converts wire millimetres (CV_16UC1, 0 = none) to metres (CV_32FC1, NaN = none).
cv::Mat depth_from_millimetres(const cv::Mat& depth_mm);

/// Converts metres (CV_32FC1, NaN = none) to wire millimetres (CV_16UC1, 0 = none); depth beyond 65.535 m becomes none.
cv::Mat depth_to_millimetres(const cv::Mat& depth);

/// Throws InputError naming `source` unless types and sizes are as RgbdFrame states and agree with the camera.
void check_frame(const RgbdFrame& frame, const std::string& source);

}  // namespace houghstream
