#include "tools/studies/recorded/pose_sheets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "pipeline/geometry/renderer.hpp"
#include "tools/view/drawing/tiles.hpp"

namespace houghstream {
namespace {

/// Returns the colour of a visible point of a triangle; `bary` holds the weights of its second and third vertex.
cv::Vec3b colour_at(const Mesh& mesh, int triangle, const cv::Vec2f& bary) {
  if (mesh.colours.empty()) return cv::Vec3b::all(255);
  const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(triangle)];
  const cv::Vec3f sum = (1.0F - bary[0] - bary[1]) * cv::Vec3f(mesh.colours[a]) + bary[0] * cv::Vec3f(mesh.colours[b]) +
                        bary[1] * cv::Vec3f(mesh.colours[c]);
  return {cv::saturate_cast<std::uint8_t>(sum[0]), cv::saturate_cast<std::uint8_t>(sum[1]),
          cv::saturate_cast<std::uint8_t>(sum[2])};
}

}  // namespace

void draw_outline(cv::Mat& image, const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera,
                  const cv::Scalar& colour) {
  const cv::Mat depth = render_depth(mesh, T_camera_object, camera, {0, 0, camera.width, camera.height});
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(depth == depth, contours, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);  // NaN where nothing is
  cv::drawContours(image, contours, -1, colour, 1);
}

cv::Mat paint_models(const RgbdFrame& frame, const ObjectPoses& poses, const view::ClassModels& models) {
  cv::Mat image = 0.4 * frame.colour;
  for (const ObjectPose& pose : poses.poses) {
    const auto model = models.find(pose.class_name);
    if (!pose.T_camera_object || model == models.end()) continue;
    const RenderedGeometry rendered = render_geometry({{&model->second, *pose.T_camera_object, 1}}, frame.camera);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        const int triangle = rendered.triangle.at<std::int32_t>(y, x);
        if (triangle < 0) continue;
        image.at<cv::Vec3b>(y, x) = colour_at(model->second, triangle, rendered.bary.at<cv::Vec2f>(y, x));
      }
    }
  }
  return image;
}

cv::Mat draw_poses(const RgbdFrame& frame, const ObjectPoses& poses, const ObjectPoses& withheld,
                   const view::ClassModels& models, const std::string& title) {
  constexpr int kLine_px = 18;
  cv::Mat image = frame.colour.clone();
  cv::Point at(6, kLine_px);
  view::draw_text(image, title, at);
  const auto outline = [&](const ObjectPose& pose, const cv::Scalar& colour) {
    const auto model = models.find(pose.class_name);
    if (pose.T_camera_object && model != models.end())
      draw_outline(image, model->second, *pose.T_camera_object, frame.camera, colour);
  };
  for (const ObjectPose& pose : withheld.poses) outline(pose, cv::Scalar::all(255));
  for (const ObjectPose& pose : poses.poses) {
    outline(pose, view::class_colour(pose.class_id));
    at.y += kLine_px;
    view::draw_text(image, fmt::format("{} {:.2f} {}", pose.class_name, pose.detection_score, to_string(pose.status)),
                    at, 0.45, view::class_colour(pose.class_id));
  }
  return image;
}

std::vector<cv::Mat> make_sheets(const std::vector<cv::Mat>& tiles) {
  constexpr std::size_t kOnSheet = 4;
  constexpr int kColumns = 2;
  std::vector<cv::Mat> sheets;
  for (auto first = tiles.begin(); first != tiles.end();) {
    const auto last = first + std::min<std::ptrdiff_t>(kOnSheet, tiles.end() - first);
    sheets.push_back(view::tiled({first, last}, kColumns));
    first = last;
  }
  return sheets;
}

}  // namespace houghstream
