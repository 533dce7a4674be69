#pragma once

#include <opencv2/imgproc.hpp>

#include "pose/following/region_modality.hpp"
#include "tests/pose/test_scene.hpp"

namespace houghstream::test_scene {

/// Makes a closed cylinder about the z axis: its depth and outline are the same however it is turned.
inline Mesh round_can() {
  Mesh mesh;
  constexpr int kSides = 64;
  constexpr float kRadius = 0.033F;
  constexpr float kHalf = 0.06F;
  const auto at = [](float radius, int i, float z) {
    const float angle = 6.2831853F * static_cast<float>(i) / kSides;
    return Eigen::Vector3f(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int i = 0; i < kSides; ++i) {
    add_quad(mesh,
             {at(kRadius, i, -kHalf), at(kRadius, i + 1, -kHalf), at(kRadius, i + 1, kHalf), at(kRadius, i, kHalf)});
    add_quad(mesh, {at(kRadius, i, kHalf), at(kRadius, i + 1, kHalf), at(0.0F, i + 1, kHalf), at(0.0F, i, kHalf)});
    add_quad(mesh, {at(kRadius, i + 1, -kHalf), at(kRadius, i, -kHalf), at(0.0F, i, -kHalf), at(0.0F, i + 1, -kHalf)});
  }
  return mesh;
}

/// An object of one colour before a table of another one, as a camera shows them: a little blurred, with noise.
struct ModalityScene {
  Mesh object;
  Mesh ground = table();
  ObjectModel model;
  Eigen::Isometry3d truth;
  RgbdFrame frame;

  ModalityScene(Mesh mesh, double foot, const Eigen::Isometry3d& pose)
      : object(std::move(mesh)), model(make_object_model("it", object, ModelSettings())), truth(pose) {
    render(foot);
  }

  void render(double foot) {
    const std::vector<RenderItem> items = {{&object, truth, 1}, {&ground, truth * Eigen::Translation3d(0, 0, foot), 2}};
    frame = noisy_frame(items, 7);
    const RenderedGeometry rendered = render_geometry(items, kCamera);
    frame.colour.setTo(cv::Scalar(70, 90, 120));
    frame.colour.setTo(cv::Scalar(160, 120, 90), rendered.id == 1);
    cv::blur(frame.colour, frame.colour, cv::Size(3, 3));
    Random random(5);
    for (cv::Vec3b& pixel : cv::Mat_<cv::Vec3b>(frame.colour)) {
      for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<std::uint8_t>(pixel[c] + 6.0 * random.normal());
    }
  }

  /// Returns a scene with images of its own, which may be changed.
  ModalityScene copy() const {
    ModalityScene other = *this;
    other.frame.colour = frame.colour.clone();
    other.frame.depth = frame.depth.clone();
    return other;
  }

  RegionView view() const { return {frame, model, {}}; }

  ColourStatistics learnt() const {
    ColourStatistics colours;
    learn_colours(view(), make_silhouette(model, truth, 200), truth, {}, colours);
    return colours;
  }

  Eigen::Vector3d shift_of(const Eigen::Isometry3d& pose) const {
    const Eigen::Vector3d centre = model.centre.cast<double>();
    return pose * centre - truth * centre;
  }
};

inline const ModalityScene& box_scene() {
  static const ModalityScene scene(cereal_box(), -0.13, standing(35.0, 30.0, 0.8));
  return scene;
}

inline const ModalityScene& can_scene() {
  static const ModalityScene scene(round_can(), -0.06, standing(0.0, 30.0, 0.65));
  return scene;
}

}  // namespace houghstream::test_scene
