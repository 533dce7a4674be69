#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Steps in pixels at which cv::linemod looks at an image and at its half: its own defaults.
constexpr std::array<int, 2> kLinemodSteps = {5, 8};

/// The frame as cv::linemod wants it: colour (CV_8UC3) and millimetres (CV_16UC1, 0 = none), enlarged to the right and
/// below by pixels without structure where that is needed for
/// - whole numbers of steps, and rows of 16 bytes also at half size: cv::linemod asserts the former and reads unaligned
///   rows as if they were aligned (opencv_contrib#4194);
/// - `largest`, the largest template, which must fit with eight steps on each side or is not found where it is.
std::vector<cv::Mat> linemod_images(const RgbdFrame& frame, cv::Size largest);

}  // namespace houghstream
