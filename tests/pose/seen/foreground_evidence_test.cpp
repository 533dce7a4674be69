#include "pose/seen/foreground_evidence.hpp"

#include <gtest/gtest.h>

#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

/// A painted box before a grey table; colours of both as noisy_frame() has them.
struct BoxBeforeTable {
  BoxBeforeTable() {
    box.colours.assign(box.vertices.size(), cv::Vec3b(110, 140, 160));
    model = make_object_model("box", box, {});
    frame = noisy_frame({{&box, truth, 1}, {&ground, truth * Eigen::Translation3d(0, 0, -0.13), 2}}, 3);
    frame.depth.setTo(0.78F, frame.depth != frame.depth);  // the pixels that the noise loses: this camera loses none
  }
  ObjectObservation observe() const {
    Detection detection;
    detection.box_px = cv::Rect2f(180.0F, 100.0F, 300.0F, 300.0F);
    detection.centre_camera = truth.translation().cast<float>();
    return observe_object(make_frame_context(frame, {}, {}), detection, model, {});
  }
  static RenderedRegion render(const ObjectObservation& observation) {
    return render_depth_region(observation.model.mesh, standing(30.0, 30.0, 0.8), kCamera);
  }

  Mesh box = cereal_box();
  Mesh ground = table();
  Eigen::Isometry3d truth = standing(30.0, 30.0, 0.8);
  ObjectModel model;
  RgbdFrame frame;
};

constexpr double kDepth_m = 0.8;
const cv::Point kPixel(300, 250);

/// Returns the evidence at a pixel after it was given this depth and the object's colour, or the table's.
double evidence_of(float depth, bool is_painted, bool is_beyond_model, bool with_colours = true) {
  BoxBeforeTable scene;
  const cv::Scalar paint = is_painted ? cv::Scalar(110, 140, 160) : cv::Scalar(90, 90, 90);
  const cv::Rect about(kPixel - cv::Point(3, 3), cv::Size(7, 7));
  scene.frame.depth(about).setTo(depth);
  scene.frame.colour(about).setTo(paint);
  const ObjectObservation observation = scene.observe();
  const auto nowhere = [](const cv::Point& /*at_px*/) { return false; };
  const ForegroundEvidence foreground(observation, BoxBeforeTable::render(observation), {0.008, {}},
                                      with_colours ? std::function<bool(const cv::Point&)>(nowhere) : nullptr);
  return foreground.at(kPixel, kDepth_m, is_beyond_model);
}

TEST(ForegroundEvidence, DepthAndColourSpeakTogether) {
  EXPECT_GT(evidence_of(0.8F, true, true), 0.9) << "the object's depth and colour";
  EXPECT_LT(evidence_of(0.8F, false, true), -0.8) << "another surface at its depth";
  EXPECT_EQ(evidence_of(0.9F, false, true), -1.0) << "the camera sees past it";
  EXPECT_EQ(evidence_of(0.9F, true, true), 0.0) << "past something thin of its colour";
  EXPECT_EQ(evidence_of(0.9F, true, false), -1.0) << "before the object itself";
}

TEST(ForegroundEvidence, WhatIsNearerSaysNothing) {
  EXPECT_EQ(evidence_of(0.7F, false, true), 0.0);
  EXPECT_EQ(evidence_of(0.7F, true, false), 0.0);
}

TEST(ForegroundEvidence, WithoutDepthColoursSpeakAtHalfTheirWeight) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_GT(evidence_of(none, true, true), 0.4);
  EXPECT_LT(evidence_of(none, false, true), -0.4);
  EXPECT_EQ(evidence_of(none, true, false), 0.0);
}

TEST(ForegroundEvidence, WithoutColoursDepthDecides) {
  EXPECT_EQ(evidence_of(0.8F, false, true, false), 0.5);
  EXPECT_EQ(evidence_of(0.9F, true, true, false), -1.0);
}

}  // namespace
}  // namespace houghstream
