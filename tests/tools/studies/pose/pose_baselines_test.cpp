#include "tools/studies/pose/pose_baselines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

/// Describes a table with one object on it.
struct Table {
  Mesh object;
  Mesh top = table();
  Eigen::Isometry3d truth;
  RgbdFrame frame;
  Detection detection;

  Table(Mesh mesh, double foot, const Eigen::Isometry3d& pose) : object(std::move(mesh)), truth(pose) {
    frame = noisy_frame({{&object, truth, 1}, {&top, truth * Eigen::Translation3d(0, 0, foot), 2}}, 7);
    detection = detection_of("it", object, truth, 1);
  }
};

Table with_mug() {
  return {mug(), -0.05, standing(35.0, 30.0, 0.9)};
}

Table with_box() {
  return {cereal_box(), -0.13, standing(35.0, 30.0, 1.1)};
}

using Make = std::unique_ptr<BaselineEstimator> (*)(const std::map<std::string, Mesh>&, const PoseSettings&);

std::unique_ptr<BaselineEstimator> prerejective(const std::map<std::string, Mesh>& models,
                                                const PoseSettings& settings) {
  return make_prerejective_baseline(models, settings, PrerejectiveSettings());
}

std::unique_ptr<BaselineEstimator> point_pairs(const std::map<std::string, Mesh>& models,
                                               const PoseSettings& settings) {
  return make_ppf_baseline(models, settings, PpfSettings());
}

class PoseRivals : public testing::TestWithParam<Make> {
 protected:
  static std::unique_ptr<BaselineEstimator> baseline(const Table& table, const PoseSettings& settings = {}) {
    return GetParam()({{"it", table.object}}, settings);
  }
};

TEST_P(PoseRivals, FindAnObjectOnATableWithoutItsVotes) {
  for (Table table : {with_mug(), with_box()}) {
    table.detection.rotations.clear();
    const auto T_camera_object = baseline(table)->estimate(table.frame, table.detection);
    ASSERT_TRUE(T_camera_object);
    EXPECT_LT(SurfaceError(table.object)(table.truth, *T_camera_object), 0.006);
    EXPECT_NEAR(T_camera_object->linear().determinant(), 1.0, 1e-9);
  }
}

TEST_P(PoseRivals, FindItWhereVotesAreNotForItsOrigin) {
  Table table = with_box();
  PoseSettings settings;
  settings.model.vote_centres["it"] = {0.0F, 0.0F, 0.1F};
  table.detection.centre_camera = table.truth.cast<float>() * settings.model.vote_centres["it"];
  const auto T_camera_object = baseline(table, settings)->estimate(table.frame, table.detection);
  ASSERT_TRUE(T_camera_object);
  EXPECT_LT(SurfaceError(table.object)(table.truth, *T_camera_object), 0.006);
}

TEST_P(PoseRivals, GiveTheSameBitsAgain) {
  const Table table = with_mug();
  const auto first = baseline(table)->estimate(table.frame, table.detection);
  const auto other = baseline(table);
  const auto second = other->estimate(table.frame, table.detection);
  const auto third = other->estimate(table.frame, table.detection);
  ASSERT_TRUE(first && second && third);
  EXPECT_EQ(first->matrix(), second->matrix());
  EXPECT_EQ(first->matrix(), third->matrix());
}

TEST_P(PoseRivals, GiveNothingWhereThereIsNothing) {
  Table table = with_mug();
  const auto it = baseline(table);

  Detection unknown = table.detection;
  unknown.class_name = "other";
  EXPECT_FALSE(it->estimate(table.frame, unknown));

  Detection without_centre = table.detection;
  without_centre.centre_camera.setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(it->estimate(table.frame, without_centre));

  Detection tiny = table.detection;
  tiny.box_px = {300.0F, 200.0F, 4.0F, 4.0F};
  EXPECT_FALSE(it->estimate(table.frame, tiny));

  table.frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(it->estimate(table.frame, table.detection));
}

TEST_P(PoseRivals, StayNearTheDetectedCentre) {
  Table table = with_mug();
  table.detection.centre_camera.x() += 0.12F;
  const auto T_camera_object = baseline(table)->estimate(table.frame, table.detection);
  if (!T_camera_object) return;
  EXPECT_LE((T_camera_object->translation() - table.detection.centre_camera.cast<double>()).norm(),
            PoseSettings().registration.max_shift_m);
}

TEST_P(PoseRivals, RefuseAFrameWithoutDepthImage) {
  Table table = with_mug();
  table.frame.depth = cv::Mat();
  EXPECT_THROW(baseline(table)->estimate(table.frame, table.detection), InputError);
}

TEST(PoseRivalSettings, OutOfRangeAreRefused) {
  const std::map<std::string, Mesh> models = {{"it", mug()}};
  PrerejectiveSettings sampling;
  sampling.samples = 2;
  EXPECT_THROW(make_prerejective_baseline(models, PoseSettings(), sampling), InputError);
  PpfSettings pairs;
  pairs.reference_fraction = 0.0;
  EXPECT_THROW(make_ppf_baseline(models, PoseSettings(), pairs), InputError);
}

INSTANTIATE_TEST_SUITE_P(Libraries, PoseRivals, testing::Values(Make(prerejective), Make(point_pairs)),
                         [](const auto& made) { return made.index == 0 ? "Prerejective" : "PointPairs"; });

}  // namespace
}  // namespace houghstream
