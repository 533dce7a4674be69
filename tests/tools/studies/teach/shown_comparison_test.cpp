#include "tools/studies/teach/shown_comparison.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgproc.hpp>

#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "tests/test_files.hpp"

namespace houghstream::studies {
namespace {

namespace fs = std::filesystem;

const Camera kCamera{160, 120, 140.0, 140.0, 79.5, 59.5};
constexpr int kFrames = 6;
constexpr int kId = 3;

/// Returns a block of 60 x 80 x 100 mm with a step in it, so that it has no symmetry.
Mesh block() {
  Mesh mesh;
  for (const float x : {-0.03F, 0.03F}) {
    for (const float y : {-0.04F, 0.04F}) {
      for (const float z : {-0.05F, 0.05F}) mesh.vertices.emplace_back(x, y, x > 0.0F && y > 0.0F ? 0.6F * z : z);
    }
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  mesh.colours.assign(mesh.vertices.size(), {60, 90, 120});
  compute_normals(mesh);
  return mesh;
}

Eigen::Isometry3d view(int frame) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Eigen::Vector3d(0.0, 0.0, 0.5));
  T.rotate(Eigen::AngleAxisd(-1.9, Eigen::Vector3d::UnitX()));
  T.rotate(Eigen::AngleAxisd(2.0 * M_PI * frame / (kFrames - 1), Eigen::Vector3d::UnitZ()));
  return T;
}

/// Returns the taught model's frame in the true one.
Eigen::Isometry3d known_frame() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Eigen::Vector3d(0.01, -0.02, -0.05));
  T.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  return T;
}

struct Shot {
  RgbdFrame frame;
  GroundTruthObject object;
  cv::Mat mask;
};

Shot shoot(int number) {
  Shot shot;
  const cv::Mat depth = render_depth(block(), view(number), kCamera, {0, 0, kCamera.width, kCamera.height});
  shot.frame.camera = kCamera;
  shot.frame.depth = depth;
  shot.frame.colour = cv::Mat(depth.size(), CV_8UC3, cv::Scalar(10 * number, 50, 90));
  shot.mask = depth == depth;  // NaN differs from itself
  shot.object.object_id = kId;
  shot.object.T_camera_object = view(number);
  shot.object.box_visible_px = cv::boundingRect(shot.mask);
  return shot;
}

void write_takes(const fs::path& folder) {
  BopWriter writer(folder / "test" / "000001");
  for (int i = 0; i < kFrames; ++i) {
    const Shot shot = shoot(i);
    writer.add(shot.frame, {shot.object}, {shot.mask});
  }
  writer.finish();
  write_bop_models({{kId, "block", block(), {}}}, folder / "models");
  std::ofstream(folder / "takes.json") << R"([{"scene": 1, "object": "block", "id": 3}])";
}

/// Writes a take as hs-teach show keeps it: every other frame is a keyframe, with the upper half of its mask; the last
/// frame's pose is 4 mm off.
Mesh write_kept(const fs::path& folder) {
  fs::create_directories(folder);
  BopWriter writer(folder / "views" / "000001");
  std::ofstream poses(folder / "camera_poses.csv");
  poses << "frame,utime,tracked,r11\n1,5,0,,,,,,,,,,,,\n";
  for (int i = 0; i < kFrames; ++i) {
    Shot shot = shoot(i);
    shot.object.T_camera_object = view(i) * known_frame();
    const cv::Rect box = shot.object.box_visible_px;
    shot.mask.rowRange(box.y + box.height / 2, shot.mask.rows) = 0;
    if (i % 2 == 0) writer.add(shot.frame, {shot.object}, {shot.mask});
    if (i == kFrames - 1) shot.object.T_camera_object.pretranslate(Eigen::Vector3d(0.004, 0.0, 0.0));
    poses << i << "," << i << ",1";
    for (int k = 0; k < 12; ++k) poses << "," << fmt::format("{:.8f}", shot.object.T_camera_object(k / 4, k % 4));
    poses << "\n";
  }
  writer.finish();
  Mesh taught = block();
  for (Eigen::Vector3f& vertex : taught.vertices) vertex = known_frame().inverse().cast<float>() * vertex;
  return taught;
}

TEST(ShownComparison, APerfectMeshIsFoundPerfectWhateverItsFrame) {
  const fs::path folder = fresh_folder("shown_comparison");
  write_takes(folder / "takes");
  const Mesh taught = write_kept(folder / "kept");
  const ShownComparison found = compare_shown(read_true_takes(folder / "takes", "block"), folder / "kept", taught);
  EXPECT_TRUE(found.T_true_taught.isApprox(known_frame(), 1e-3));
  EXPECT_LT(found.taught_to_true.maximum, 1e-4);
  EXPECT_LT(found.seen_to_taught.maximum, 1e-4);
  EXPECT_EQ(found.missing_fraction, 0.0);
  EXPECT_GT(found.seen_surface, 0.5);
  EXPECT_LT(found.seen_surface, 0.95) << "the bottom is never seen";
  EXPECT_EQ(found.tracked, kFrames);
  EXPECT_NEAR(found.drift.shift_m, 0.004, 1e-5);
  EXPECT_NEAR(found.drift.angle_rad, 0.0, 1e-5);
  EXPECT_EQ(found.views, 3);
  EXPECT_GT(found.mask_iou, 0.35);
  EXPECT_LT(found.mask_iou, 0.65);
  EXPECT_FALSE(found.second.has_value());
}

TEST(ShownComparison, AMeshThatIsTooLargeOrLacksASideIsTold) {
  const fs::path folder = fresh_folder("shown_comparison_wrong");
  write_takes(folder / "takes");
  Mesh taught = write_kept(folder / "kept");
  const TrueTakes takes = read_true_takes(folder / "takes", "block");
  Mesh larger = taught;
  const Eigen::Vector3f middle = mesh_bounds(taught).center();
  for (Eigen::Vector3f& vertex : larger.vertices) vertex = middle + 1.2F * (vertex - middle);
  EXPECT_GT(compare_shown(takes, folder / "kept", larger).taught_to_true.median, 0.004);
  taught.triangles.resize(taught.triangles.size() - 4);
  const ShownComparison open = compare_shown(takes, folder / "kept", taught);
  EXPECT_LT(open.taught_to_true.maximum, 1e-4);
  EXPECT_GT(open.missing_fraction, 0.05);
}

TEST(ShownComparison, WhatIsMissingIsNamed) {
  const fs::path folder = fresh_folder("shown_comparison_missing");
  write_takes(folder / "takes");
  EXPECT_THROW(read_true_takes(folder / "takes", "bowl"), InputError);
  const Mesh taught = write_kept(folder / "kept");
  std::ofstream(folder / "kept" / "camera_poses.csv") << "frame,utime,tracked\n0,1,1,2,3\n";
  EXPECT_THROW(compare_shown(read_true_takes(folder / "takes", "block"), folder / "kept", taught), InputError);
}

}  // namespace
}  // namespace houghstream::studies
