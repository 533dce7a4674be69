#pragma once

#include <cstdint>

#include "tools/render/world/world.hpp"

namespace houghstream {

/// The picture a colour camera takes of linear light (CV_32FC3 BGR): lens blur, vignetting, automatic exposure,
/// white balance, shot and read noise, sRGB. Returns CV_8UC3 BGR. Same seed, same picture.
cv::Mat take_photo(const cv::Mat& radiance, const PhotoSettings& settings, std::uint64_t seed);

}  // namespace houghstream
