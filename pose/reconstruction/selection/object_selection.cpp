#include "pose/reconstruction/selection/object_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "pose/reconstruction/selection/support_clusters.hpp"

namespace houghstream::reconstruction {
namespace {

cv::Point2d target_pixel(const RgbdFrame& frame, const SelectionSettings& settings) {
  if (settings.box_px) return (settings.box_px->tl() + settings.box_px->br()) * 0.5;
  if (settings.at_px) return *settings.at_px;
  return {0.5 * frame.depth.cols, 0.5 * frame.depth.rows};
}

/// Returns the cluster of the target; 0 = none.
int find_target_cluster(const std::vector<Cluster>& clusters, const RgbdFrame& frame,
                        const SelectionSettings& settings) {
  constexpr int kMinPixels = 60;
  constexpr double kMaxFoot_m = 0.035;
  int best = 0;
  double best_rank = 1e18;
  for (std::size_t i = 1; i < clusters.size(); ++i) {
    const Cluster& cluster = clusters[i];
    if (cluster.pixels < kMinPixels || cluster.lowest > kMaxFoot_m) continue;
    if (!settings.box_px && cluster.target_distance_px > settings.max_fraction * frame.depth.cols) continue;
    const double rank = settings.box_px ? -cluster.pixels : cluster.target_distance_px - 1e-6 * cluster.pixels;
    if (rank >= best_rank) continue;
    best_rank = rank;
    best = static_cast<int>(i);
  }
  return best;
}

/// Returns why the selected cluster cannot be taught; empty where it can.
std::string find_fault(const SelectedObject& object, const RgbdFrame& frame, const SelectionSettings& settings) {
  const double widest = std::max(2.0 * object.radius_m, object.height_m);
  if (widest > settings.max_m)
    return fmt::format(
        "what is meant is {:.0f} cm large, expected at most {:.0f} cm that stand apart from other things", 1e2 * widest,
        1e2 * settings.max_m);
  if (std::max(object.radius_m, object.height_m) < settings.min_m)
    return fmt::format("what is meant is {:.0f} mm large, expected at least {:.0f} mm", 1e3 * widest,
                       1e3 * settings.min_m);
  const cv::Rect inner(2, 2, frame.depth.cols - 4, frame.depth.rows - 4);
  if ((object.box_px & inner) != object.box_px)
    return "what is meant is cut by the picture's edge, expected the whole object in the first picture";
  return {};
}

SelectedObject describe_cluster(const RgbdFrame& frame, const Plane& plane, const PlaneAxes& axes,
                                const Clusters& found, int selected) {
  const Cluster& cluster = found.clusters[static_cast<std::size_t>(selected)];
  SelectedObject object;
  object.mask = found.labels == selected;
  object.box_px = cv::boundingRect(object.mask);
  constexpr double kMinSkinFraction = 0.15;
  object.is_skin_coloured =
      cv::countNonZero(skin_pixels(frame.colour) & object.mask) > kMinSkinFraction * cv::countNonZero(object.mask);
  const Eigen::Vector3d middle =
      axes.point_at(cluster.cells.x + 0.5 * cluster.cells.width, cluster.cells.y + 0.5 * cluster.cells.height);
  object.plane = refine_plane(frame, object.mask, plane, middle, 0.5);
  object.radius_m = 0.5 * PlaneAxes::kCell_m * std::hypot(cluster.cells.width, cluster.cells.height);
  object.height_m = cluster.highest;
  const Eigen::Vector3d& z = object.plane.normal();
  const Eigen::Vector3d x = (axes.x - axes.x.dot(z) * z).normalized();
  object.T_camera_stand.linear() << x, z.cross(x), z;
  object.T_camera_stand.translation() = middle - object.plane.signedDistance(middle) * z;
  return object;
}

/// Returns whether the surface about a pixel is horizontal.
bool is_level(const RgbdFrame& frame, const Plane& plane, int x, int y) {
  constexpr int kApart_px = 3;
  constexpr double kCosine = 0.9;
  if (x < kApart_px || y < kApart_px || x + kApart_px >= frame.depth.cols || y + kApart_px >= frame.depth.rows)
    return false;
  const auto point = [&](int u, int v) { return frame.camera.backproject(u, v, frame.depth.at<float>(v, u)); };
  const Eigen::Vector3d normal =
      (point(x + kApart_px, y) - point(x - kApart_px, y)).cross(point(x, y + kApart_px) - point(x, y - kApart_px));
  return normal.allFinite() && std::abs(normal.normalized().dot(plane.normal())) > kCosine;
}

/// Returns the top of a disc, book or lid on which the object stands: a wide horizontal surface below a narrower part.
/// Nothing where the cluster has none.
std::optional<Plane> find_raised_support(const RgbdFrame& frame, const SelectedObject& object) {
  constexpr double kBin_m = 0.002;
  constexpr double kMax_m = 0.06;
  constexpr double kAbove_m = 0.012;
  constexpr double kMinFraction = 0.25;
  std::array<int, 31> height_counts{};
  int all = 0;
  for (int y = 0; y < object.mask.rows; ++y) {
    for (int x = 0; x < object.mask.cols; ++x) {
      if (object.mask.at<std::uint8_t>(y, x) == 0) continue;
      ++all;
      const double height = object.plane.signedDistance(frame.camera.backproject(x, y, frame.depth.at<float>(y, x)));
      if (height < kMax_m && is_level(frame, object.plane, x, y))
        ++height_counts[static_cast<std::size_t>(height / kBin_m)];
    }
  }
  std::size_t best = 1;
  const auto about = [&](std::size_t i) { return height_counts[i - 1] + height_counts[i] + height_counts[i + 1]; };
  for (std::size_t i = 1; i + 1 < height_counts.size(); ++i) best = about(i) > about(best) ? i : best;
  if (about(best) < kMinFraction * all) return std::nullopt;
  const double level = kBin_m * (static_cast<double>(best) + 0.5);
  cv::Mat on_level = cv::Mat::zeros(object.mask.size(), CV_8UC1);
  Eigen::AlignedBox2d level_box, above_box;
  const Eigen::Isometry3d T_stand_camera = object.T_camera_stand.inverse();
  for (int y = 0; y < object.mask.rows; ++y) {
    for (int x = 0; x < object.mask.cols; ++x) {
      if (object.mask.at<std::uint8_t>(y, x) == 0) continue;
      const Eigen::Vector3d p = T_stand_camera * frame.camera.backproject(x, y, frame.depth.at<float>(y, x));
      if (std::abs(p.z() - level) < 2.0 * kBin_m) {
        on_level.at<std::uint8_t>(y, x) = 255;
        level_box.extend(p.head<2>());
      } else if (p.z() > level + kAbove_m) {
        above_box.extend(p.head<2>());
      }
    }
  }
  if (above_box.isEmpty() || above_box.diagonal().norm() > 0.85 * level_box.diagonal().norm()) return std::nullopt;
  Plane plane = object.plane;
  plane.offset() -= level;
  const cv::Mat elsewhere = on_level == 0;
  return refine_plane(frame, elsewhere, plane, object.T_camera_stand.translation(), 0.5);
}

std::string describe_absence(const SelectionSettings& settings) {
  if (settings.box_px) return "nothing with depth stands in the box, expected an object on the table there";
  if (settings.at_px)
    return fmt::format("nothing with depth stands near {},{}, expected an object on the table there", settings.at_px->x,
                       settings.at_px->y);
  return "nothing with depth stands near the picture's middle, expected an object there (or --box; what is transparent "
         "has no depth)";
}

/// Selects the object on this plane.
ObjectSelection select_on_plane(const RgbdFrame& frame, const Plane& plane, const SelectionSettings& settings) {
  const cv::Point2d target = target_pixel(frame, settings);
  const PlaneAxes axes(plane, frame.camera.backproject(target.x, target.y, 1.0));
  const cv::Rect whole({0, 0}, frame.depth.size());
  const Clusters found =
      find_clusters(frame, plane, axes, {settings.box_px.value_or(whole) & whole, target, settings.max_distance_m});
  const int selected = find_target_cluster(found.clusters, frame, settings);
  if (selected == 0) return {{}, describe_absence(settings)};
  SelectedObject object = describe_cluster(frame, plane, axes, found, selected);
  object.has_given_box = settings.box_px.has_value();
  if (const std::optional<Plane> raised_support = find_raised_support(frame, object)) {
    if (ObjectSelection raised = select_on_plane(frame, *raised_support, settings); raised.object) return raised;
  }
  std::string fault = find_fault(object, frame, settings);
  if (!fault.empty()) return {{}, std::move(fault)};
  return {std::move(object), {}};
}

}  // namespace

cv::Mat skin_pixels(const cv::Mat& colour) {
  cv::Mat ycrcb, skin;
  cv::cvtColor(colour, ycrcb, cv::COLOR_BGR2YCrCb);
  cv::inRange(ycrcb, cv::Scalar(20, 136, 77), cv::Scalar(255, 176, 127), skin);
  return skin;
}

ObjectSelection select_object(const RgbdFrame& frame, const SelectionSettings& settings) {
  const cv::Rect whole({0, 0}, frame.depth.size());
  if (settings.box_px && (*settings.box_px & whole) != *settings.box_px)
    return {{}, fmt::format("the box lies not within the picture, which has {}x{} pixels", whole.width, whole.height)};
  if (settings.at_px && !whole.contains(*settings.at_px))
    return {{},
            fmt::format("{},{} lies not within the picture, which has {}x{} pixels", settings.at_px->x,
                        settings.at_px->y, whole.width, whole.height)};
  const std::vector<Plane> planes = find_planes(frame, settings.max_distance_m, settings.seed);
  if (planes.empty()) return {{}, "no table or other level surface is seen, expected one on which the object stands"};
  ObjectSelection first;
  for (const Plane& plane : planes) {
    ObjectSelection selection = select_on_plane(frame, plane, settings);
    if (selection.object) return selection;
    if (first.reason.empty()) first = std::move(selection);
  }
  return first;
}

std::string describe_selection(const SelectedObject& object) {
  const cv::Point middle = (object.box_px.tl() + object.box_px.br()) / 2;
  return fmt::format("meant is what stands at {},{} in the picture, {:.0f} cm across and {:.0f} cm high", middle.x,
                     middle.y, 2e2 * object.radius_m, 1e2 * object.height_m);
}

std::optional<cv::Rect> project_box(const Eigen::AlignedBox3d& box, const Camera& camera,
                                    const Eigen::Isometry3d& T_camera_box) {
  std::vector<cv::Point2f> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d p = T_camera_box * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    if (p.z() < 0.05) return std::nullopt;
    const Eigen::Vector2d px = camera.project(p);
    corners.emplace_back(static_cast<float>(px.x()), static_cast<float>(px.y()));
  }
  return cv::boundingRect(corners);
}

}  // namespace houghstream::reconstruction
