#pragma once

#include <Eigen/Core>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// A frame's depth image and its camera in single precision, for many pixels.
struct PixelRays {
  explicit PixelRays(const RgbdFrame& frame)
      : focal(static_cast<float>(frame.camera.fx), static_cast<float>(frame.camera.fy)),
        centre(static_cast<float>(frame.camera.cx), static_cast<float>(frame.camera.cy)),
        first(frame.camera.backproject(0, 0, 1.0).cast<float>()),
        step((frame.camera.backproject(1, 1, 1.0) - frame.camera.backproject(0, 0, 1.0)).cast<float>()),
        columns(frame.depth.cols),
        rows(frame.depth.rows),
        row_step(static_cast<int>(frame.depth.step1())) {}

  static constexpr float kWidest = 65536.0F;  ///< pixels; more than any image has

  Eigen::Vector2f focal;   ///< pixels
  Eigen::Vector2f centre;  ///< pixels
  Eigen::Vector3f first;   ///< of pixel (0,0), with z = 1
  Eigen::Vector3f step;    ///< between neighbours
  int columns;
  int rows;
  int row_step;  ///< values of depth
};

}  // namespace houghstream
