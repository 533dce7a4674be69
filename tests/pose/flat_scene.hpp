#pragma once

#include "pose/seen/foreground_search.hpp"
#include "tests/pose/test_scene.hpp"

namespace houghstream::test_scene {

/// A pen, thicker at one end, that lies on a grey table, with or without a taller box of its paint beside it.
struct FlatScene {
  explicit FlatScene(double azimuth_deg, bool with_box = false)
      : truth(standing(azimuth_deg, 45.0, 0.7)), model(make_object_model("pen", painted(), {})) {
    std::vector<RenderItem> items = {{&mesh, truth, 1}, {&ground, truth * Eigen::Translation3d(0, 0, -0.007), 2}};
    if (with_box) items.push_back({&box, truth * Eigen::Translation3d(0.0, 0.09, 0.05), 1});
    frame = noisy_frame(items, 3);
  }
  static Mesh pen() {
    Mesh shape;
    add_box(shape, {-0.07F, -0.008F, -0.007F}, {0.03F, 0.008F, 0.007F});
    add_box(shape, {0.03F, -0.016F, -0.007F}, {0.07F, 0.016F, 0.007F});
    return shape;
  }
  static Mesh painted() {
    Mesh shape = pen();
    shape.colours.assign(shape.vertices.size(), cv::Vec3b(110, 140, 160));  // of the first item of noisy_frame()
    return shape;
  }
  static Mesh tall_box() {
    Mesh shape;
    add_box(shape, {-0.02F, -0.02F, -0.05F}, {0.02F, 0.02F, 0.05F});
    return shape;
  }
  ObjectObservation observe() const {
    Detection detection = detection_of("pen", mesh, truth, 1);
    detection.box_px += cv::Size2f(40.0F, 40.0F);  // boxes of detections are no exact silhouettes
    detection.box_px -= cv::Point2f(20.0F, 20.0F);
    ObjectObservation observation = observe_object(make_frame_context(frame, {}, {}), detection, model, {});
    observation.foreground = find_surface_foreground(observation);
    return observation;
  }

  Mesh mesh = pen();
  Mesh ground = table();
  Mesh box = tall_box();
  Eigen::Isometry3d truth;
  ObjectModel model;
  RgbdFrame frame;
};

}  // namespace houghstream::test_scene
