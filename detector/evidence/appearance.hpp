#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// What a training view shows, over its box and a rim around it: depth relative to the object's centre, and colour.
struct Appearance {
  static constexpr int kBoxSide = 20;  ///< cells per side of the box
  static constexpr int kRim = 2;       ///< cells around it
  static constexpr int kSide = kBoxSide + 2 * kRim;
  static constexpr std::int16_t kBeside = -32768;   ///< the cell does not show the object
  static constexpr std::int16_t kNoDepth = -32767;  ///< it does, but no depth was measured
  using Cells = std::array<std::int16_t, kSide * kSide>;
  Cells mm{};      ///< row by row; as it lies across the ray to the centre, see ReliefTilt
  Cells beside{};  ///< beside the outline: depth of the nearest cell of the object; elsewhere kBeside
  std::array<std::array<std::uint8_t, 3>, kSide * kSide> lab{};  ///< colour, 8-bit CIE L*a*b*; of the object only
};

/// What is to be remembered of a view: `mask` is CV_8UC1, 255 on the object, `box_px` its bounding box, `centre_camera`
/// the object's centre, metres.
Appearance remember_appearance(const RgbdFrame& view, const cv::Mat& mask, const cv::Rect& box_px,
                               const Eigen::Vector3f& centre_camera);

}  // namespace houghstream
