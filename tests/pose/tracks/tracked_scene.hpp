#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pose/tracks/tracker.hpp"
#include "tests/pose/test_scene.hpp"

// A camera over a table on which cans stand, for the tests of tracks: depth is rendered, poses are the truth with
// noise.

namespace houghstream::tracks::test {

inline const Camera kSmall{320, 240, 262.5, 262.5, 159.5, 119.5};
constexpr std::int64_t kFrameUs = 33333;

/// Returns a block of 7 x 7 x 12 cm.
inline Mesh block() {
  Mesh mesh;
  test_scene::add_box(mesh, {-0.035F, -0.035F, -0.06F}, {0.035F, 0.035F, 0.06F});
  return mesh;
}

/// Returns the model with its origin at its foot.
inline Mesh block_on_foot() {
  Mesh mesh;
  test_scene::add_box(mesh, {-0.035F, -0.035F, 0.0F}, {0.035F, 0.035F, 0.12F});
  return mesh;
}

/// Returns the frame at its foot in the frame in its middle.
inline Eigen::Isometry3d foot() {
  return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -0.06));
}

/// Turns the block on its head, in the frame at its foot.
inline Eigen::Isometry3d half_turn() {
  return foot().inverse() * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()) * foot();
}

/// Returns the block that has its origin at its foot as a can, which looks the same on its head.
inline TrackModels models_on_foot() {
  return make_track_models({{"can", block_on_foot()}}, {{"can", {{half_turn()}, {}}}});
}

/// Returns a camera above and in front of the table, which is z = 0.
inline Eigen::Isometry3d camera_in_front(double x = 0.0) {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.translate(Eigen::Vector3d(x, -0.8, 0.6));
  T_world_camera.rotate(Eigen::AngleAxisd(-M_PI / 2 - 0.6, Eigen::Vector3d::UnitX()));
  return T_world_camera;
}

inline Eigen::Isometry3d on_table(double x, double y, double angle_rad = 0.0) {
  return Eigen::Translation3d(x, y, 0.06) * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ());
}

/// Returns the pose of a block that occludes the middle of the table.
inline Eigen::Isometry3d before_the_middle() {
  return Eigen::Isometry3d(Eigen::Translation3d(0.0, -0.22, 0.22));
}

inline double distance(const TrackedObject& object, const Eigen::Isometry3d& T) {
  return (object.T_world_object.translation() - T.translation()).norm();
}

/// Shows a world to a tracker frame by frame.
class TrackedScene {
 public:
  explicit TrackedScene(ObjectTrackerSettings settings = {})
      : table_([] {
          Mesh mesh;
          test_scene::add_box(mesh, {-0.7F, -0.5F, -0.02F}, {0.7F, 0.7F, 0.0F});
          return mesh;
        }()),
        block_(block()),
        tracker(make_track_models({{"can", block()}, {"mug", block()}}, {}), settings) {}

  std::vector<std::pair<std::string, Eigen::Isometry3d>> standing;  ///< objects in the depth image
  std::vector<std::pair<std::string, Eigen::Isometry3d>> posed;     ///< objects with a published pose
  std::optional<Eigen::Isometry3d> obstacle;                        ///< a block between
  Eigen::Isometry3d T_world_camera = camera_in_front();
  Camera camera = kSmall;
  std::string channel = "CAMERA";
  std::map<std::string, int> class_ids = {{"can", 1}};  ///< other classes have 2
  double noise_m = 0.0;
  double quality = 0.9;
  std::int64_t utime = 1000000000;
  FrameNumber number = {};  ///< number of the camera's next frame

  /// Objects that are present have poses.
  void show(const std::vector<std::pair<std::string, Eigen::Isometry3d>>& objects) { standing = posed = objects; }

  WorldObjects frame() {
    utime += kFrameUs;
    return look();
  }

  WorldObjects frames(int count) {
    WorldObjects last;
    for (int i = 0; i < count; ++i) last = frame();
    return last;
  }

  /// Sends a frame at the same time, as of another camera.
  WorldObjects look() { return look_if_any().value(); }

  /// Returns nothing where the tracker ignores the frame.
  std::optional<WorldObjects> look_if_any() {
    std::optional<RgbdFrame> image;
    const auto render = [&]() -> const RgbdFrame* {
      image = depth();
      return &*image;
    };
    return tracker.update({poses(), nullptr, T_world_camera, render, std::nullopt, number});
  }

  ObjectPoses poses() {
    poses_ = {};
    poses_.frame = {channel, utime};
    for (const auto& [name, T_world_object] : posed) {
      ObjectPose pose;
      pose.class_id = class_ids.count(name) > 0 ? class_ids.at(name) : 2;
      pose.class_name = name;
      pose.status = PoseStatus::kValid;
      pose.quality = static_cast<float>(quality);
      pose.visible_fraction = 0.9F;
      pose.T_camera_object = T_world_camera.inverse() * T_world_object;
      pose.T_camera_object->pretranslate(
          noise_m * Eigen::Vector3d(random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-1, 1)));
      poses_.poses.push_back(pose);
    }
    return poses_;
  }

 private:
  RgbdFrame depth() const {
    std::vector<RenderItem> items = {{&table_, T_world_camera.inverse(), 1}};
    for (const auto& [name, T_world_object] : standing)
      items.push_back({&block_, T_world_camera.inverse() * T_world_object, 2});
    if (obstacle) items.push_back({&block_, T_world_camera.inverse() * *obstacle, 3});
    RgbdFrame frame;
    frame.id = {channel, utime};
    frame.camera = camera;
    frame.depth = render_geometry(items, camera).depth;
    frame.colour = cv::Mat(camera.height, camera.width, CV_8UC3, cv::Scalar::all(128));
    return frame;
  }

  Mesh table_;
  Mesh block_;
  Random random_{7};
  ObjectPoses poses_;

 public:
  Tracker tracker;
};

}  // namespace houghstream::tracks::test
