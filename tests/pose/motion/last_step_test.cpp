#include "pose/motion/last_step.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

const Eigen::Isometry3d kFirst(Eigen::Translation3d(0.1, 0.0, 1.0) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));
const Eigen::Isometry3d kStep(Eigen::Translation3d(0.01, 0.0, 0.02) * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()));

TEST(LastStep, IsDoneOnceMoreAndAtRestLeadsNowhere) {
  LastStep step;
  step.restart(kFirst);
  EXPECT_TRUE(step.repeat_of_camera().isApprox(kFirst, 1e-12));
  step.advance(kStep * kFirst);
  EXPECT_TRUE(step.repeat_of_camera().isApprox(kStep * kStep * kFirst, 1e-12));
  EXPECT_TRUE(step.repeat_of_object().isApprox(step.repeat_of_camera(), 1e-12));
}

TEST(LastStep, APoseIsCorrectedAndTheStepStaysWhatItWas) {
  LastStep step;
  step.restart(kFirst);
  step.advance(kStep * kFirst);
  const Eigen::Isometry3d better = Eigen::Translation3d(0.0, 0.03, 0.0) * step.T_last;
  step.correct(better);
  EXPECT_EQ(step.T_last.matrix(), better.matrix());
  EXPECT_TRUE(step.repeat_of_camera().isApprox(kStep * better, 1e-12));
}

}  // namespace
}  // namespace houghstream
