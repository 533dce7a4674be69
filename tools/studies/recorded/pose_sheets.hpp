#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "tools/view/drawing/overlay.hpp"

namespace houghstream {

/// Draws the thinnest outline of a posed model, holes and all, into an image of the camera (CV_8UC3, BGR, its size).
void draw_outline(cv::Mat& image, const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera,
                  const cv::Scalar& colour);

/// Draws the frame's image (CV_8UC3, BGR, its size) with each valid pose's model as the thinnest outline, holes and
/// all, so that the surface under it stays visible; below the title a line for each pose: class, score, outcome.
/// `withheld` are rejected poses: their outlines are white.
cv::Mat draw_poses(const RgbdFrame& frame, const ObjectPoses& poses, const ObjectPoses& withheld,
                   const view::ClassModels& models, const std::string& title);

/// Draws the image, darkened, with each valid pose's model in its own colours (white where it has none): a wrong
/// rotation is evident beside draw_poses' image.
cv::Mat paint_models(const RgbdFrame& frame, const ObjectPoses& poses, const view::ClassModels& models);

/// Tiles of one size on sheets of 2 by 2; at least one sheet where there are tiles.
std::vector<cv::Mat> make_sheets(const std::vector<cv::Mat>& tiles);

}  // namespace houghstream
