#include "pose/reconstruction/map/pose_graph.hpp"

#include <gtest/gtest.h>

#include "pose/motion/twist.hpp"
#include "pose/reconstruction/map/view_sphere.hpp"

namespace houghstream::reconstruction {
namespace {

Eigen::Isometry3d on_circle(int i, int count, double too_far) {
  const double angle = 6.283185307179586 * i / count * (1.0 + too_far);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0.0, 0.0, 0.6);
  return T;
}

TEST(PoseGraph, SpreadsTheGapOfALoop) {
  constexpr int kPoses = 24;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<PoseEdge> edges;
  poses.reserve(kPoses);
  for (int i = 0; i < kPoses; ++i) poses.push_back(on_circle(i, kPoses, 0.01));
  for (int i = 0; i + 1 < kPoses; ++i)
    edges.push_back({i, i + 1, poses[static_cast<std::size_t>(i) + 1] * poses[static_cast<std::size_t>(i)].inverse(),
                     1e6 * Matrix6::Identity()});
  edges.push_back({0, kPoses - 1, on_circle(kPoses - 1, kPoses, 0.0) * on_circle(0, kPoses, 0.0).inverse(),
                   1e6 * Matrix6::Identity()});
  EXPECT_EQ(graph_distances(0, kPoses, edges)[12], 12);
  optimise_pose_graph(edges, poses);
  const auto error = [&](int i) {
    return local_coordinates_about_body(poses[static_cast<std::size_t>(i)].inverse() * on_circle(i, kPoses, 0.0))
        .tail<3>()
        .norm();
  };
  EXPECT_LT(error(kPoses - 1), 0.01);  // 0.06 before
  EXPECT_LT(error(12), 0.01);          // 0.03 before
  EXPECT_LT(error(0), 1e-9);
}

TEST(SphereOfDirections, FillsAndSaysWhatIsMissing) {
  ViewCoverage coverage{};
  mark_covered({1.0, 0.0, 0.7}, coverage);
  const int once = count_covered(coverage);
  EXPECT_GT(once, 5);
  EXPECT_LT(once, 20);
  const std::string text = describe_coverage(coverage, {1.0, 0.0, 0.7});
  EXPECT_NE(text.find("of 60 directions; from"), std::string::npos);
  EXPECT_NE(text.find("behind"), std::string::npos);
  EXPECT_EQ(text.find("in front"), std::string::npos);
}

}  // namespace
}  // namespace houghstream::reconstruction
