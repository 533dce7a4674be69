#include "pose/fusion/tsdf_volume.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/pose/fusion/turntable_views.hpp"

namespace houghstream::fusion {
namespace {

using test_scene::TurntableScene;

const Eigen::Vector3d kHalf(0.09, 0.03, 0.13);  // half the size of the cereal box

std::vector<DepthView> box_views() {
  std::vector<DepthView> views;
  for (const TrainingView& view : turntable_views(TurntableScene{test_scene::cereal_box()})) {
    views.push_back(make_depth_view(view));
  }
  return views;
}

TsdfSettings coarse() {
  TsdfSettings settings;
  settings.voxel = 0.003;
  return settings;
}

TEST(TsdfVolume, HoldsTheBoxsDistances) {
  const TsdfSettings settings = coarse();
  const TsdfVolume grid = integrate_views(box_views(), settings);
  const double truncation = settings.truncation_voxels * settings.voxel;
  std::vector<double> errors;
  int wrong_side = 0;
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        const double truth = test_scene::box_distance(grid.centre(i, j, k), kHalf);
        const double distance = static_cast<double>(grid.distance[grid.index(i, j, k)]);
        wrong_side += std::abs(truth) > 2.0 * settings.voxel && (truth < 0.0) != (distance < 0.0) ? 1 : 0;
        if (grid.weight[grid.index(i, j, k)] > 0.0F && std::abs(truth) < 0.5 * truncation) {
          errors.push_back(std::abs(distance * truncation - truth));
        }
      }
    }
  }
  EXPECT_LT(wrong_side, static_cast<int>(grid.distance.size() / 1000));
  EXPECT_LT(test_scene::median(errors), 0.001);
}

TEST(TsdfVolume, DoesNotDependOnThreads) {
  TsdfSettings settings = coarse();
  settings.voxel = 0.006;
  const std::vector<DepthView> views = box_views();
  const TsdfVolume one = integrate_views(views, settings);
  settings.threads = 3;
  EXPECT_EQ(one.distance, integrate_views(views, settings).distance);
}

TEST(TsdfVolume, BesideTheImagesIsFreeBesideTheImageNothingIsKnown) {
  DepthView view = make_depth_view(turntable_view(TurntableScene{test_scene::cereal_box()}, 0));
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-0.2, -0.01, -0.01), Eigen::Vector3d(0.2, 0.01, 0.01));
  TsdfSettings settings;
  settings.voxel = 0.01;
  settings.outline_weight = 1.0;
  const auto weight_at = [&](double x) {
    const TsdfVolume grid = integrate_box({view}, box, settings);
    const Eigen::Vector3d cell = (Eigen::Vector3d(x, 0.0, 0.0) - grid.origin) / grid.voxel;
    const Eigen::Vector3i at = cell.array().round().cast<int>();
    return grid.weight[grid.index(at.x(), at.y(), at.z())];
  };
  EXPECT_EQ(weight_at(-0.2), 1.0F);  // left of the images
  EXPECT_EQ(weight_at(0.2), 1.0F);   // right of them
  view.image = cv::Rect(0, -80, 440, 480);
  EXPECT_EQ(weight_at(-0.2), 0.0F);
  EXPECT_EQ(weight_at(0.2), 1.0F);
}

TEST(TsdfVolume, WhatCannotBeFusedIsRefused) {
  EXPECT_THROW(integrate_views({}, coarse()), InputError);
  TsdfSettings tiny = coarse();
  tiny.max_voxels = 1000;
  EXPECT_THROW(integrate_views(box_views(), tiny), InputError);
  TsdfSettings none = coarse();
  none.voxel = 0.0;
  EXPECT_THROW(integrate_views(box_views(), none), InputError);
}

}  // namespace
}  // namespace houghstream::fusion
