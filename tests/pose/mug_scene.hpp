#pragma once

#include "pose/seen/handle_observation.hpp"
#include "tests/pose/test_scene.hpp"

namespace houghstream::test_scene {

inline constexpr double kBeside_deg = 0.0;    // azimuth at which the handle is to the right of the mug
inline constexpr double kBehind_deg = 90.0;   // azimuth at which the mug hides it
inline constexpr double kBefore_deg = -90.0;  // azimuth at which it points at the camera
inline const DepthTolerance kHandleTolerance{0.008, {}};

inline Mesh painted_mug() {
  Mesh mesh = mug();
  mesh.colours.assign(mesh.vertices.size(), cv::Vec3b(110, 140, 160));  // of the first item of noisy_frame()
  return mesh;
}

inline Eigen::Isometry3d mug_at(double azimuth_deg) {
  return standing(azimuth_deg, 30.0, 0.8);
}

/// A mug on a grey table, with or without a grey slab where its handle could be.
struct MugScene {
  explicit MugScene(double azimuth_deg, const Mesh& taught = painted_mug(), bool with_slab = false)
      : truth(mug_at(azimuth_deg)), model(make_object_model("mug", taught, {})) {
    std::vector<RenderItem> items = {{&mesh, truth, 1}, {&ground, truth * Eigen::Translation3d(0, 0, -0.05), 2}};
    if (with_slab) items.push_back({&slab, mug_at(kBeside_deg), 3});
    frame = noisy_frame(items, 3);
  }
  static Mesh make_slab() {
    Mesh box;
    add_box(box, {0.043F, -0.006F, -0.034F}, {0.075F, 0.006F, 0.034F});
    return box;
  }
  ObjectObservation observe() const {
    Detection detection;
    detection.box_px = cv::Rect2f(240.0F, 150.0F, 200.0F, 200.0F);
    detection.centre_camera = truth.translation().cast<float>();
    return observe_object(make_frame_context(frame, {}, {}), detection, model, {});
  }
  std::optional<Eigen::Isometry3d> turn_from(double azimuth_deg) const {
    const ObjectObservation observation = observe();
    return HandleObserver(observation, mug_at(azimuth_deg), kHandleTolerance).find_turn();
  }
  HandleObservation handle_at(double azimuth_deg) const {
    const ObjectObservation observation = observe();
    return HandleObserver(observation, truth, kHandleTolerance).observe_at(mug_at(azimuth_deg));
  }

  Mesh mesh = mug();
  Mesh ground = table();
  Mesh slab = make_slab();
  Eigen::Isometry3d truth;
  ObjectModel model;
  RgbdFrame frame;
};

}  // namespace houghstream::test_scene
