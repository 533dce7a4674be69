#include "pose/model/view_look.hpp"

#include <algorithm>

namespace houghstream {

ViewLook look_at_view(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                      int points) {
  ViewLook result{nearest_view(model, T_camera_object), T_camera_object.cast<float>(), {}};
  const auto columns = static_cast<float>(frame.depth.cols);
  const auto rows = static_cast<float>(frame.depth.rows);
  result.looks.resize(std::min<std::size_t>(static_cast<std::size_t>(std::max(0, points)), result.view.points.size()));
  for (std::size_t i = 0; i < result.looks.size(); ++i) {
    const Eigen::Vector3f point = result.T * result.view.points[i];
    if (!(point.z() > 0.0F)) continue;
    const Eigen::Vector2f pixel = frame.camera.project_single(point) + Eigen::Vector2f::Constant(0.5F);
    if (!(pixel.x() >= 0.0F && pixel.y() >= 0.0F && pixel.x() < columns && pixel.y() < rows)) continue;
    Look& look = result.looks[i];
    look.x = static_cast<int>(pixel.x());
    look.y = static_cast<int>(pixel.y());
    look.beyond = frame.depth.ptr<float>(look.y)[look.x] - point.z();
  }
  return result;
}

}  // namespace houghstream
