#include "pose/registration/flat_candidates.hpp"

#include <gtest/gtest.h>

#include "tests/pose/flat_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

TEST(FlatCandidates, APenIsLaidWhereItLies) {
  for (const double azimuth_deg : {20.0, 75.0, 200.0}) {
    const FlatScene scene(azimuth_deg);
    const std::vector<PoseCandidate> candidates = flat_candidates(scene.observe(), 4);
    ASSERT_FALSE(candidates.empty()) << azimuth_deg;
    EXPECT_LE(candidates.size(), 4U);
    const Eigen::Isometry3d& best = candidates.front().T_camera_object;
    EXPECT_LT((best.translation() - scene.truth.translation()).norm(), 0.012) << azimuth_deg;
    EXPECT_GT(best.linear().col(0).dot(scene.truth.linear().col(0)), 0.97) << "its thick end, at " << azimuth_deg;
    EXPECT_GT(std::abs(best.linear().col(2).dot(scene.truth.linear().col(2))), 0.99) << "flat, at " << azimuth_deg;
    for (std::size_t i = 1; i < candidates.size(); ++i) EXPECT_LE(candidates[i].score, candidates[i - 1].score);
  }
}

TEST(FlatCandidates, WithoutAForegroundThereAreNone) {
  const FlatScene scene(20.0);
  ObjectObservation observation = scene.observe();
  observation.foreground.reset();
  EXPECT_TRUE(flat_candidates(observation, 4).empty());
}

}  // namespace
}  // namespace houghstream
