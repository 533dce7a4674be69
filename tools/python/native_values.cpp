#include "tools/python/native_values.hpp"

#include <Eigen/Core>
#include <cmath>
#include <cstring>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>

#include "pipeline/base/checks.hpp"

namespace py = pybind11;

namespace houghstream {
namespace {

template <typename Derived>
py::array_t<double> matrix_to_python(const Eigen::MatrixBase<Derived>& matrix) {
  py::array_t<double> out({static_cast<py::ssize_t>(matrix.rows()), static_cast<py::ssize_t>(matrix.cols())});
  auto values = out.mutable_unchecked<2>();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index column = 0; column < matrix.cols(); ++column)
      values(row, column) = static_cast<double>(matrix(row, column));
  return out;
}

template <typename Derived>
py::array_t<double> vector_to_python(const Eigen::MatrixBase<Derived>& vector) {
  py::array_t<double> out(static_cast<py::ssize_t>(vector.size()));
  auto values = out.mutable_unchecked<1>();
  for (Eigen::Index i = 0; i < vector.size(); ++i) values(i) = static_cast<double>(vector(i));
  return out;
}

py::dict frame_to_python(const FrameId& frame) {
  py::dict out;
  out["utime"] = frame.utime;
  out["camera"] = frame.channel;
  return out;
}

py::object box_to_python(const Detection* detection) {
  if (detection == nullptr) return py::none();
  const cv::Rect2f& box = detection->box_px;
  return py::make_tuple(box.x, box.y, box.width, box.height);
}

// The evidence that is there with and without a pose.
py::dict common_to_python(const ObjectPose& pose, const Detection* detection) {
  py::dict out;
  out["name"] = pose.class_name;
  out["score"] = pose.detection_score;
  out["status"] = to_string(pose.status);
  out["box"] = box_to_python(detection);
  return out;
}

py::dict pose_to_python(const ObjectPose& pose, const Detection* detection) {
  py::dict out = common_to_python(pose, detection);
  out["matrix"] = matrix_to_python(pose.T_camera_object->matrix());
  out["quality"] = pose.quality;
  out["shape_quality"] = pose.shape_quality;
  out["up_to_symmetry"] = pose.status == PoseStatus::kValidUpToSymmetry;
  out["inliers"] = pose.inliers;
  out["inlier_fraction"] = pose.inlier_fraction;
  out["residual"] = pose.residual;
  out["visible_fraction"] = pose.visible_fraction;
  out["free_space_violation"] = pose.free_space_violation;
  out["covariance"] = py::none();
  out["bounds"] = py::none();
  return out;
}

py::object bounds_to_python(const std::string& name, const ObjectFinder& finder) {
  for (const FinderObject& object : finder.objects()) {
    if (object.name == name)
      return py::make_tuple(vector_to_python(object.bounds.min()), vector_to_python(object.bounds.max()));
  }
  return py::none();
}

const Detection* find_detection(const ObjectPose& pose, const Detections* detections) {
  const auto index = static_cast<std::size_t>(pose.detection_index);
  const bool is_known = detections != nullptr && pose.detection_index >= 0 && index < detections->detections.size();
  return is_known ? &detections->detections[index] : nullptr;
}

py::dict poses_to_python(const ObjectPoses& poses, const Detections* detections, const ObjectFinder* finder) {
  py::list posed;
  py::list without_pose;
  for (const ObjectPose& pose : poses.poses) {
    const Detection* detection = find_detection(pose, detections);
    if (!pose.T_camera_object) {
      if (detection == nullptr || detection->reported) without_pose.append(common_to_python(pose, detection));
      continue;
    }
    py::dict entry = pose_to_python(pose, detection);
    if (finder != nullptr) {
      entry["covariance"] = matrix_to_python(finder->covariance(pose));
      entry["bounds"] = bounds_to_python(pose.class_name, *finder);
    }
    posed.append(entry);
  }
  py::dict out = frame_to_python(poses.frame);
  out["poses"] = posed;
  out["without_pose"] = without_pose;
  return out;
}

void add_place(const ObjectPlacement* place, py::dict& entry) {
  py::dict frames;
  if (place == nullptr) {
    entry["box_matrix"] = py::none();
    entry["extents"] = py::none();
  } else {
    entry["box_matrix"] = matrix_to_python(place->T_world_box.matrix());
    entry["extents"] = vector_to_python(place->box_size);
    for (const PlacedObjectFrame& frame : place->frames)
      frames[py::str(frame.name)] = matrix_to_python(frame.T_world_frame.matrix());
  }
  entry["frames"] = frames;
}

cv::Mat depth_from_metres(const cv::Mat& metres) {
  constexpr float kMaxDepth_m = 65.535F;
  cv::Mat depth = metres.clone();
  int measured = 0;
  int far = 0;
  for (int row = 0; row < depth.rows; ++row) {
    auto* values = depth.ptr<float>(row);
    for (int column = 0; column < depth.cols; ++column) {
      float& value = values[column];
      if (!(value > 0.0F) || std::isinf(value)) {
        value = std::numeric_limits<float>::quiet_NaN();
        continue;
      }
      ++measured;
      far += value > kMaxDepth_m ? 1 : 0;
    }
  }
  require(2 * far <= measured, "depth: found {} of {} values above {} m, expected float32 metres (uint16 millimetres)",
          far, measured, kMaxDepth_m);
  return depth;
}

}  // namespace

RgbdFrame make_frame(const FrameArrays& arrays) {
  const Camera& camera = arrays.camera;
  check_camera(camera, "camera");
  RgbdFrame frame;
  frame.camera = camera;
  // OpenCV has no images of constant pixels; both are only read.
  const cv::Mat colour(camera.height, camera.width, CV_8UC3, const_cast<void*>(arrays.colour));
  if (arrays.is_bgr) {
    frame.colour = colour.clone();
  } else {
    cv::cvtColor(colour, frame.colour, cv::COLOR_RGB2BGR);
  }
  const int type = arrays.is_depth_in_mm ? CV_16UC1 : CV_32FC1;
  const cv::Mat depth(camera.height, camera.width, type, const_cast<void*>(arrays.depth));
  frame.depth = arrays.is_depth_in_mm ? depth_from_millimetres(depth) : depth_from_metres(depth);
  check_frame(frame, "frame");
  return frame;
}

py::dict to_python(const FoundObjects& found, const ObjectFinder& finder) {
  return poses_to_python(found.poses, &found.detections, &finder);
}

py::dict to_python(const PosedDetections& posed) {
  return poses_to_python(posed.poses, posed.detections ? &*posed.detections : nullptr, nullptr);
}

py::dict to_python(const PlacedWorld& placed_world) {
  const WorldObjects& world = placed_world.world;
  py::list objects;
  for (const TrackedObject& object : world.objects) {
    py::dict entry;
    entry["number"] = object.track_id;
    entry["name"] = object.class_name;
    entry["state"] = to_string(object.state);
    entry["probability"] = object.probability;
    entry["moving"] = object.moving;
    entry["matrix"] = matrix_to_python(object.T_world_object.matrix());
    entry["covariance"] = matrix_to_python(object.covariance);
    entry["velocity"] = vector_to_python(object.velocity);
    entry["times_seen"] = object.seen;
    entry["first_utime"] = object.first_utime;
    entry["seen_utime"] = object.last_seen.utime;
    entry["seen_by"] = object.last_seen.channel;
    entry["reason"] = object.reason;
    add_place(placed_world.placed ? placed_world.placed->find(object.track_id) : nullptr, entry);
    objects.append(entry);
  }
  py::dict out = frame_to_python(world.frame);
  out["world"] = world.world;
  out["world_number"] = world.world_number;
  out["camera_matrix"] = matrix_to_python(world.T_world_camera.matrix());
  out["objects"] = objects;
  return out;
}

}  // namespace houghstream
