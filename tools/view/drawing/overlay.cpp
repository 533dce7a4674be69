#include "tools/view/drawing/overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/renderer.hpp"

namespace houghstream::view {
namespace {

constexpr double kDefaultAxis = 0.05;  // metres, for a class without a model
constexpr int kSubpixelBits = 4;       // anti-aliased lines are placed to 1/16 of a pixel
const cv::Scalar kDark(20, 20, 20);

void draw_box(cv::Mat& image, const Detection& detection) {
  const cv::Rect box = detection.box_px;
  cv::rectangle(image, box, kDark, 3);
  cv::rectangle(image, box, class_colour(detection.class_id), 2);
}

Label label_of_detection(const Detection& detection, const ObjectPose* pose) {
  Label label{fmt::format("{} {:.2f}", detection.class_name, detection.score), detection.box_px,
              class_colour(detection.class_id), detection.class_id};
  if (pose != nullptr && pose->status != PoseStatus::kValid)
    label.text += fmt::format(" ({})", to_string(pose->status));
  return label;
}

// Returns the index of the track that a detection shows: of its class, with its centre in the detection's box and
// nearest to the middle of it. Returns nothing where there is none.
std::optional<std::size_t> track_of(const Detection& detection, const std::vector<Label>& tracks) {
  const auto middle_of = [](const auto& rectangle) {
    return cv::Point2f(static_cast<float>(rectangle.x) + 0.5F * static_cast<float>(rectangle.width),
                       static_cast<float>(rectangle.y) + 0.5F * static_cast<float>(rectangle.height));
  };
  std::optional<std::size_t> nearest;
  double nearest_px = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const cv::Point2f centre = middle_of(tracks[i].thing);
    const double distance_px = cv::norm(centre - middle_of(detection.box_px));
    if (tracks[i].class_id != detection.class_id || !detection.box_px.contains(centre) || distance_px >= nearest_px)
      continue;
    nearest = i;
    nearest_px = distance_px;
  }
  return nearest;
}

// Returns the shape drawn for a class without a model: ten centimetres around its origin.
Mesh unknown_shape() {
  const float half = static_cast<float>(kDefaultAxis);
  Mesh cube;
  for (const float x : {-half, half}) {
    for (const float y : {-half, half}) {
      for (const float z : {-half, half}) cube.vertices.emplace_back(x, y, z);
    }
  }
  return cube;
}

// Returns the region in which the model may be visible; empty when any of it is at or behind the camera.
cv::Rect projected_region(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera) {
  Eigen::Vector2d low(1e9, 1e9);
  Eigen::Vector2d high(-1e9, -1e9);
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d point = T_camera_object * vertex.cast<double>();
    if (point.z() < kNearPlane) return {};
    const Eigen::Vector2d pixel = camera.project(point).cwiseMax(-1e6).cwiseMin(1e6);
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  const cv::Point corner(static_cast<int>(low.x()) - 2, static_cast<int>(low.y()) - 2);
  const cv::Point opposite(static_cast<int>(high.x()) + 3, static_cast<int>(high.y()) + 3);
  return cv::Rect(corner, opposite) & cv::Rect(0, 0, camera.width, camera.height);
}

void draw_outline(cv::Mat& image, const Mesh& mesh, const ObjectPose& pose, const Camera& camera) {
  const cv::Rect region = projected_region(mesh, *pose.T_camera_object, camera);
  if (region.empty()) return;
  const cv::Mat depth = render_depth(mesh, *pose.T_camera_object, camera, region);
  const cv::Mat seen = depth == depth;  // false where nothing was rendered (NaN)
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(seen, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE, region.tl());
  cv::drawContours(image, contours, -1, kDark, 4, cv::LINE_AA);
  cv::drawContours(image, contours, -1, class_colour(pose.class_id), 2, cv::LINE_AA);
}

// Returns half the model's largest extent: long enough to leave the surface, short enough not to hide the neighbours.
double axis_length(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  return mesh.vertices.empty() ? kDefaultAxis : 0.5 * box.sizes().maxCoeff();
}

void draw_axes(cv::Mat& image, const Eigen::Isometry3d& T_camera_object, double length, const Camera& camera) {
  const std::array<cv::Scalar, 3> colours = {cv::Scalar(60, 60, 255), cv::Scalar(60, 220, 60),
                                             cv::Scalar(255, 120, 60)};
  const auto pixel_of = [&](const Eigen::Vector3d& point_camera) {
    const Eigen::Vector2d pixel = camera.project(point_camera).cwiseMax(-1e4).cwiseMin(1e4) * (1 << kSubpixelBits);
    return cv::Point(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  };
  const Eigen::Vector3d origin = T_camera_object.translation();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d tip = T_camera_object * (length * Eigen::Vector3d::Unit(axis));
    if (origin.z() < kNearPlane || tip.z() < kNearPlane) continue;
    cv::line(image, pixel_of(origin), pixel_of(tip), kDark, 4, cv::LINE_AA, kSubpixelBits);
    cv::line(image, pixel_of(origin), pixel_of(tip), colours[axis], 2, cv::LINE_AA, kSubpixelBits);
  }
}

// Returns the pose of each detection, null where there is none.
std::vector<const ObjectPose*> poses_by_detection(const Detections& detections,
                                                  const std::optional<ObjectPoses>& poses) {
  std::vector<const ObjectPose*> found(detections.detections.size(), nullptr);
  if (!poses) return found;
  for (const ObjectPose& pose : poses->poses) {
    require(pose.detection_index >= 0 && pose.detection_index < static_cast<int>(found.size()),
            "poses of frame {}: detection index {}, expected 0 to {}", to_string(poses->frame), pose.detection_index,
            static_cast<int>(found.size()) - 1);
    found[pose.detection_index] = &pose;
  }
  return found;
}

// Returns the labels of detections, each with the text of its track where it shows one, and of the other tracks.
std::vector<Label> one_label_an_object(const Detections& detections, const std::vector<const ObjectPose*>& pose_of,
                                       std::vector<Label> tracks) {
  std::vector<Label> labels;
  for (std::size_t i = 0; i < detections.detections.size(); ++i) {
    const Detection& detection = detections.detections[i];
    labels.push_back(label_of_detection(detection, pose_of[i]));
    const std::optional<std::size_t> track = track_of(detection, tracks);
    if (!track) continue;
    labels.back().text = tracks[*track].text;
    tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(*track));
  }
  labels.insert(labels.end(), tracks.begin(), tracks.end());
  return labels;
}

}  // namespace

cv::Scalar class_colour(int class_id) {
  static const std::array<cv::Scalar, 8> kColours = {
      cv::Scalar(0, 159, 230), cv::Scalar(233, 180, 86), cv::Scalar(115, 158, 0),   cv::Scalar(66, 228, 240),
      cv::Scalar(178, 114, 0), cv::Scalar(0, 94, 213),   cv::Scalar(167, 121, 204), cv::Scalar(255, 255, 255)};
  const int count = static_cast<int>(kColours.size());
  return kColours[((class_id - 1) % count + count) % count];
}

BoxedPoses boxed(const ObjectPoses& followed, const ClassModels& models, const Camera& camera) {
  BoxedPoses all{{followed.frame, {}, followed.stages}, {followed.frame, {}, followed.stages}};
  const Mesh unknown = unknown_shape();
  for (const ObjectPose& pose : followed.poses) {
    if (!pose.T_camera_object) continue;
    const auto model = models.find(pose.class_name);
    const Mesh& shape = model != models.end() ? model->second : unknown;
    const cv::Rect region = projected_region(shape, *pose.T_camera_object, camera);
    if (region.empty()) continue;
    Detection detection;
    detection.class_id = pose.class_id;
    detection.class_name = pose.class_name;
    detection.score = pose.detection_score;
    detection.box_px = region;
    // The votes of a store are cast for this point; the origin of a mesh may lie anywhere.
    detection.centre_camera = pose.T_camera_object->cast<float>() * mesh_bounds(shape).center();
    all.poses.poses.push_back(pose);
    all.poses.poses.back().detection_index = static_cast<int>(all.detections.detections.size());
    all.detections.detections.push_back(std::move(detection));
  }
  return all;
}

cv::Mat draw_overlay(const RgbdFrame& frame, const Detections& detections, const std::optional<ObjectPoses>& poses,
                     const ClassModels& models, const TrackLabels& tracks) {
  const std::string name = to_string(frame.id);
  check_frame(frame, "frame " + name);
  require(detections.frame == frame.id, "detections of frame {} drawn over frame {}", to_string(detections.frame),
          name);
  require(!poses || poses->frame == frame.id, "poses of frame {} drawn over frame {}",
          poses ? to_string(poses->frame) : "", name);
  const std::vector<const ObjectPose*> pose_of = poses_by_detection(detections, poses);
  cv::Mat image = frame.colour.clone();
  for (const Detection& detection : detections.detections) draw_box(image, detection);
  for (const ObjectPose* pose : pose_of) {
    if (pose != nullptr) draw_pose(image, *pose, models, frame.camera);
  }
  // Labels come last and the surest first: nothing covers their names.
  draw_labels(image, one_label_an_object(detections, pose_of, tracks.labels), tracks.occupied);
  return image;
}

void draw_pose(cv::Mat& image, const ObjectPose& pose, const ClassModels& models, const Camera& camera) {
  if (!pose.T_camera_object) return;
  const auto model = models.find(pose.class_name);
  if (model != models.end()) draw_outline(image, model->second, pose, camera);
  const double length = model == models.end() ? kDefaultAxis : axis_length(model->second);
  draw_axes(image, *pose.T_camera_object, length, camera);
}

void draw_text(cv::Mat& image, const std::string& text, cv::Point origin_px, double scale, const cv::Scalar& colour) {
  cv::putText(image, text, origin_px, cv::FONT_HERSHEY_SIMPLEX, scale, kDark, 3, cv::LINE_AA);
  cv::putText(image, text, origin_px, cv::FONT_HERSHEY_SIMPLEX, scale, colour, 1, cv::LINE_AA);
}

}  // namespace houghstream::view
