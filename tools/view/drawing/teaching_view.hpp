#pragma once

#include <opencv2/core.hpp>

#include "pipeline/types/frame.hpp"
#include "pipeline/types/teaching.hpp"

namespace houghstream::view {

/// Draws over an image of the frame (CV_8UC3, BGR) how it goes with an object that is shown: its box and axes, where
/// the teaching is of this camera and of about this time; at the upper right the sphere of directions, filled where the
/// object was seen from, once from where the camera is now and once from behind; at the lower edge state and words,
/// with a bar as long as the state's progress.
void draw_teaching(cv::Mat& image, const Teaching& teaching, const RgbdFrame& frame);

/// Draws a sphere of directions, rotated by `R_view_object`, in a square: those on the near side, observed ones filled.
/// Positions are those of the directions' points on the sphere in an orthographic view.
void draw_sphere(cv::Mat& image, const cv::Rect& square, const std::vector<ViewDirection>& directions,
                 const Eigen::Matrix3f& R_view_object);

}  // namespace houghstream::view
