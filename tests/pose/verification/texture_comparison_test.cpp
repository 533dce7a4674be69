#include "pose/verification/texture_comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "tests/pose/mug_scene.hpp"
#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

constexpr double kTolerance_m = 0.008;
const Eigen::Isometry3d kTruth = standing(30.0, 30.0, 0.8);

/// Compares the box in the frame with alternatives of a pose.
std::optional<TextureComparison> compared_at(const Eigen::Isometry3d& T_camera_object, const Mesh& taught,
                                             const RgbdFrame& frame) {
  const ObjectModel model = make_object_model("box", taught, {});
  Detection detection;
  detection.box_px = cv::Rect2f(0.0F, 0.0F, 640.0F, 480.0F);
  detection.centre_camera = T_camera_object.translation().cast<float>();
  const FrameContext seen_frame = make_frame_context(frame, {}, {});
  const ObjectObservation observation = observe_object(seen_frame, detection, model, {});
  return compare_with_alternatives(observation, T_camera_object, {kTolerance_m, {}}, {});
}

/// Returns the frame with the camera's response applied to each colour.
RgbdFrame through_camera(RgbdFrame frame, const std::function<double(double, int)>& response) {
  for (int y = 0; y < frame.colour.rows; ++y) {
    for (int x = 0; x < frame.colour.cols; ++x) {
      auto& pixel = frame.colour.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<std::uint8_t>(response(pixel[c], c));
    }
  }
  return frame;
}

void expect_told(const RgbdFrame& frame, const std::string& what) {
  const std::optional<TextureComparison> right = compared_at(kTruth, printed_box(), frame);
  ASSERT_TRUE(right.has_value()) << what;
  EXPECT_GT(right->margin, 2.0) << what;
  EXPECT_FALSE(right->better.has_value()) << what;
  const std::optional<TextureComparison> turned_over = compared_at(rotated(kTruth, 180.0), printed_box(), frame);
  ASSERT_TRUE(turned_over.has_value()) << what;
  EXPECT_LT(turned_over->margin, -2.0) << what;
  ASSERT_TRUE(turned_over->better.has_value()) << what;
  EXPECT_LT((turned_over->better->matrix() - kTruth.matrix()).norm(), 1e-3) << what;
}

TEST(TextureComparison, TellsABoxFromItselfTurnedOver) {
  expect_told(coloured_frame(printed_box(), kTruth, 1), "as it is");
}

TEST(TextureComparison, TellsThroughAnotherCamera) {
  const RgbdFrame frame = coloured_frame(printed_box(), kTruth, 1);
  expect_told(through_camera(frame, [](double value, int) { return 0.5 * value; }), "dark");
  expect_told(through_camera(frame, [](double value, int) { return 255.0 * std::pow(value / 255.0, 0.7); }), "gamma");
  expect_told(through_camera(frame, [](double value, int c) { return value * (c == 0 ? 0.8 : 1.05); }), "warm light");
}

/// Returns a can whose label has narrow stripes of unequal widths and colours.
Mesh printed_can() {
  constexpr int kSides = 96;
  constexpr float kRadius = 0.05F;
  constexpr float kHalf = 0.07F;
  constexpr float kFullTurn_rad = 6.2831853F;
  const std::array<cv::Vec3b, 4> paints = {cv::Vec3b(200, 60, 40), cv::Vec3b(230, 230, 230), cv::Vec3b(40, 40, 60),
                                           cv::Vec3b(30, 120, 220)};
  const auto ring = [&](int i, float z) {
    const float angle = kFullTurn_rad * static_cast<float>(i) / kSides;
    return Eigen::Vector3f(kRadius * std::cos(angle), kRadius * std::sin(angle), z);
  };
  Mesh mesh;
  Random random(5);
  cv::Vec3b paint = paints[0];
  for (int i = 0; i < kSides; ++i) {
    if (i % 2 == 0) paint = paints.at(static_cast<std::size_t>(random.below(4)));
    add_quad(mesh, {ring(i, -kHalf), ring(i + 1, -kHalf), ring(i + 1, kHalf), ring(i, kHalf)});
    add_quad(mesh, {ring(i, kHalf), ring(i + 1, kHalf), {0.0F, 0.0F, kHalf}, {0.0F, 0.0F, kHalf}});
    add_quad(mesh, {ring(i + 1, -kHalf), ring(i, -kHalf), {0.0F, 0.0F, -kHalf}, {0.0F, 0.0F, -kHalf}});
    mesh.colours.insert(mesh.colours.end(), 4, paint);
    mesh.colours.insert(mesh.colours.end(), 8, cv::Vec3b(150, 150, 150));
  }
  return mesh;
}

/// Colours may be registered two pixels beside the depth, which are 3.5 degrees of the can.
constexpr double kWithin_deg = 5.0;

TEST(TextureComparison, ACanIsTurnedToWhereItsLabelIs) {
  const RgbdFrame frame = coloured_frame(printed_can(), kTruth, 1);
  for (const double off_deg : {9.0, -9.0}) {
    const std::optional<TextureComparison> compared = compared_at(rotated(kTruth, off_deg), printed_can(), frame);
    ASSERT_TRUE(compared.has_value());
    EXPECT_GT(compared->margin, 1.0) << off_deg;
    ASSERT_TRUE(compared->aligned.has_value()) << off_deg;
    EXPECT_LT(degrees_between(*compared->aligned, kTruth), kWithin_deg) << off_deg;
  }
}

TEST(TextureComparison, TheLabelsPlaceIsFoundBetweenTheAlternatives) {
  const RgbdFrame frame = coloured_frame(printed_can(), kTruth, 1);
  for (const double off_deg : {52.0, 127.0, -97.0}) {  // half way between samples
    const std::optional<TextureComparison> compared = compared_at(rotated(kTruth, off_deg), printed_can(), frame);
    ASSERT_TRUE(compared.has_value());
    ASSERT_TRUE(compared->better.has_value()) << off_deg;
    EXPECT_LT(degrees_between(*compared->better, kTruth), kWithin_deg) << off_deg;
  }
}

// A blurred image shows little of narrow stripes: the model's must be blurred likewise, or they would count as missing.
TEST(TextureComparison, TheLabelIsFoundInADarkAndBlurredImage) {
  const Eigen::Isometry3d far = standing(30.0, 30.0, 1.5);
  RgbdFrame frame = coloured_frame(printed_can(), far, 1);
  cv::GaussianBlur(frame.colour, frame.colour, cv::Size(), 1.2);
  frame = through_camera(frame, [](double value, int) { return 0.15 * value; });
  const std::optional<TextureComparison> right = compared_at(far, printed_can(), frame);
  ASSERT_TRUE(right.has_value());
  EXPECT_GT(right->margin, 0.5);
  const std::optional<TextureComparison> turned = compared_at(rotated(far, 52.0), printed_can(), frame);
  ASSERT_TRUE(turned.has_value());
  ASSERT_TRUE(turned->better.has_value());
  EXPECT_LT(degrees_between(*turned->better, far), kWithin_deg);
}

TEST(TextureComparison, OfAPlainObjectItIsOneOfAsMany) {
  Mesh plain = printed_box();
  for (cv::Vec3b& colour : plain.colours) colour = cv::Vec3b(40, 90, 160);
  const RgbdFrame frame = coloured_frame(plain, kTruth, 1);
  const std::optional<TextureComparison> compared = compared_at(kTruth, plain, frame);
  ASSERT_TRUE(compared.has_value());
  EXPECT_NEAR(compared->margin, -std::log(3.0), 0.3) << "three half turns";
}

TEST(TextureComparison, OfAModelWithoutColoursItIsOneOfAsMany) {
  const RgbdFrame frame = coloured_frame(printed_box(), kTruth, 1);
  const std::optional<TextureComparison> compared = compared_at(kTruth, cereal_box(), frame);
  ASSERT_TRUE(compared.has_value());
  EXPECT_DOUBLE_EQ(compared->margin, -std::log(3.0));
  EXPECT_FALSE(compared->better.has_value());
}

/// Returns a bar of one paint with a stem at one end, by which depth hardly tells it from itself turned end for end.
Mesh bar_with_stem() {
  Mesh mesh;
  add_box(mesh, {-0.06F, -0.04F, -0.02F}, {0.06F, 0.04F, 0.02F});
  add_box(mesh, {0.06F, -0.015F, -0.014F}, {0.076F, 0.015F, 0.014F});
  mesh.colours.assign(mesh.vertices.size(), cv::Vec3b(110, 140, 160));  // of the first item of noisy_frame()
  return mesh;
}

TEST(TextureComparison, TheSilhouetteTellsWhichEndHasAStem) {
  const Mesh bar = bar_with_stem();
  const Mesh ground = table();
  const RgbdFrame frame = noisy_frame({{&bar, kTruth, 1}, {&ground, kTruth * Eigen::Translation3d(0, 0, -0.02), 2}}, 1);
  const std::optional<TextureComparison> right = compared_at(kTruth, bar, frame);
  ASSERT_TRUE(right.has_value());
  EXPECT_FALSE(right->better.has_value());
  const std::optional<TextureComparison> turned = compared_at(rotated(kTruth, 180.0), bar, frame);
  ASSERT_TRUE(turned.has_value());
  ASSERT_TRUE(turned->better.has_value());
  EXPECT_GT(turned->better->linear().col(0).dot(kTruth.linear().col(0)), 0.99) << "the stem is at the other end";
}

// The handle is in plain sight beside the mug, at a turn that a mug whose handle is hidden must be compared with.
TEST(TextureComparison, AVisibleHandleSpeaksAgainstAHiddenOne) {
  const MugScene scene(kBeside_deg);
  const ObjectObservation observation = scene.observe();
  const std::optional<TextureComparison> hidden =
      compare_with_alternatives(observation, mug_at(kBehind_deg), kHandleTolerance, {});
  ASSERT_TRUE(hidden.has_value());
  EXPECT_LT(hidden->margin, -3.0);
  ASSERT_TRUE(hidden->better.has_value());
  EXPECT_LT(degrees_between(*hidden->better, scene.truth), 15.0) << "a step between turns";
}

TEST(TextureComparison, WithoutAlternativesThereIsNone) {
  ModelSettings settings;
  const ObjectModel model = make_object_model("mug", mug(), settings);
  EXPECT_TRUE(model.alternatives.empty()) << "its handle tells";
  // A box that looks the same after each half turn.
  for (int axis = 0; axis < 3; ++axis) {
    settings.symmetries["box"].discrete.emplace_back(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::Unit(axis)));
  }
  EXPECT_EQ(make_object_model("box", cereal_box(), {}).alternatives.size(), 3U);
  EXPECT_TRUE(make_object_model("box", cereal_box(), settings).alternatives.empty());
}

}  // namespace
}  // namespace houghstream
