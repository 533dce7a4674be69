#include "detector/training/augmentation/training_set.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>
#include <tuple>

#include "pipeline/base/checks.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream::training {
namespace {

constexpr float kTileArea = 0.0151F;  // 46 pixels of 0.7 m / 262.5 squared

/// Returns one flat tile 0.7 m away and one background, taught at one distance.
std::vector<TrainingView> flat_tile() {
  const std::vector<TrainingView> all = toy::training_views();
  std::vector<TrainingView> views = {all.front(), all.back()};
  views[0].frame.depth.setTo(0.7F, views[0].mask);
  return views;
}

const auto kKeepAll = [](const TrainingView*) {};

ImageInput set_input(const Profile& profile) {
  return {profile.features, profile.patch, profile.training, depth_normalised_scales()};
}

TrainingSet teach(const std::vector<TrainingView>& views, float distance, int threads = 2) {
  Profile profile = toy::quick_profile();
  profile.training.min_distance = distance;
  profile.training.max_distance = distance;
  profile.training.threads = threads;
  std::vector<const TrainingView*> pointers;
  pointers.reserve(views.size());
  for (const TrainingView& view : views) pointers.push_back(&view);
  return make_training_set(pointers, set_input(profile), kKeepAll);
}

TEST(TrainingSet, OffsetsPointFromTheSurfaceToTheCentre) {
  constexpr int kMargins = 96;  // frame pixels, of a composite
  const cv::Rect tile = cv::boundingRect(flat_tile()[0].mask);
  const TrainingSet set = teach(flat_tile(), 0.7F);
  int objects = 0;
  for (const TrainingSample& sample : set.samples) {
    if (sample.label == 0) continue;
    ++objects;
    ASSERT_EQ(sample.label, 1);
    // The image is the tile with equal margins, at its own size, as its lens is half as long as the usual one: its
    // middle shows the view's principal point.
    const double right_px = sample.x - 0.5 * (tile.width + kMargins - 1);
    const double down_px = sample.y - 0.5 * (tile.height + kMargins - 1);
    const Eigen::Vector3f point = Eigen::Vector3d(right_px / 262.5 * 0.7, down_px / 262.5 * 0.7, 0.7).cast<float>();
    const Eigen::Vector3f centre = point + ray_rotation(point) * sample.offset;
    ASSERT_LT((centre - Eigen::Vector3f(0, 0, 0.7F)).norm(), 0.001F) << sample.x << " " << sample.y;
  }
  EXPECT_EQ(objects, 150);
  EXPECT_NEAR(set.classes[0].radius, 0.08F, 0.006F);  // nearly the corner
}

TEST(TrainingSet, TheVisibleAreaDoesNotDependOnTheDistanceTaught) {
  EXPECT_NEAR(teach(flat_tile(), 0.7F).visible_areas[0], kTileArea, 0.0008F);
  EXPECT_NEAR(teach(flat_tile(), 1.1F).visible_areas[0], kTileArea, 0.0018F);
  // too near to fit the frame: taught at the view's own distance instead
  EXPECT_NEAR(teach(flat_tile(), 0.15F).visible_areas[0], kTileArea, 0.0008F);
}

TEST(TrainingSet, ViewsRememberTheirBoxInMetres) {
  const std::vector<ViewTemplate> views = teach(flat_tile(), 0.7F).views;
  ASSERT_EQ(views.size(), 1U);
  EXPECT_NEAR(views[0].box[0], -0.0613F, 0.001F);
  EXPECT_NEAR(views[0].box[3], 0.0613F, 0.001F);
  EXPECT_TRUE(views[0].R_ray_object.isApprox(Eigen::Quaternionf::Identity(), 1e-5F));
}

TEST(TrainingSet, HolesTeachNoCentre) {
  std::vector<TrainingView> views = flat_tile();
  const cv::Rect tile = cv::boundingRect(views[0].mask);
  views[0]
      .frame.depth(cv::Rect(tile.x, tile.y, tile.width / 2, tile.height))
      .setTo(std::numeric_limits<float>::quiet_NaN());
  int right = 0;
  for (const TrainingSample& sample : teach(views, 0.7F).samples) {
    if (sample.label == 0) continue;
    ++right;
    EXPECT_LT(sample.offset.x(), 0.005F);  // to the left
  }
  EXPECT_GT(right, 50);
}

TEST(TrainingSet, EachLevelLearnsBackgroundOfItsOwnDistances) {
  std::vector<TrainingView> views = flat_tile();
  cv::Mat& depth = views[1].frame.depth;
  for (int x = 0; x < depth.cols; ++x) {  // stripes: near, far, beyond both levels
    constexpr std::array<float, 3> kDepths = {0.8F, 2.0F, 6.0F};
    depth.col(x).setTo(kDepths[static_cast<std::size_t>(x / 20 % 3)]);
  }
  const TrainingSet set = teach(views, 0.7F);
  const TrainingSettings settings = toy::quick_profile().training;
  std::array<int, 2> counts{};
  for (const auto* list : {&set.samples, &set.negative_pool}) {
    for (const TrainingSample& sample : *list) {
      if (sample.image < settings.composites_per_view) continue;
      const auto level = static_cast<std::size_t>((sample.image - settings.composites_per_view) % 2);
      EXPECT_EQ(sample.label, 0);
      EXPECT_EQ(sample.scale, level == 0 ? patch_scale({}, 262.5, 0.8F) : patch_scale({}, 525.0, 2.0F));
      ++counts[level];
    }
  }
  EXPECT_GT(counts[0], 0);
  EXPECT_GT(counts[1], 0);
  EXPECT_FALSE(set.negative_pool.empty());
}

TEST(TrainingSet, AnyNumberOfThreadsGivesTheSameSamples) {
  const TrainingSet serial = teach(toy::training_views(), 0.8F, 1);
  const TrainingSet parallel = teach(toy::training_views(), 0.8F, 3);
  ASSERT_EQ(serial.samples.size(), parallel.samples.size());
  for (std::size_t i = 0; i < serial.samples.size(); ++i) {
    ASSERT_EQ(serial.samples[i].x, parallel.samples[i].x);
    ASSERT_EQ(serial.samples[i].offset, parallel.samples[i].offset);
  }
  ASSERT_EQ(serial.classes.size(), 2U);
  EXPECT_EQ(serial.classes[0].name, "stripes");
  EXPECT_EQ(serial.classes[1].name, "rings");
}

TEST(TrainingSet, ViewsWithoutAnImageAreRememberedAllTheSame) {
  const std::vector<TrainingView> views = toy::training_views();
  Profile profile = toy::quick_profile();
  profile.training.views_per_image = 2;
  std::vector<const TrainingView*> pointers;
  pointers.reserve(views.size());
  for (const TrainingView& view : views) pointers.push_back(&view);
  const TrainingSet set = make_training_set(pointers, set_input(profile), kKeepAll);
  EXPECT_EQ(set.views.size(), teach(views, 0.8F).views.size());
  std::set<std::uint32_t> with_patches;
  for (const TrainingSample& sample : set.samples) {
    if (sample.label != 0) with_patches.insert(sample.view);
  }
  EXPECT_EQ(with_patches.size(), (set.views.size() + 1) / 2);
  std::set<std::uint32_t> classes;
  for (const std::uint32_t view : with_patches) classes.insert(set.views[view].class_index);
  EXPECT_EQ(classes.size(), 2U);
}

TEST(TrainingSet, ViewsThatAreDoneMayLetTheirImagesGo) {
  std::vector<TrainingView> views = toy::training_views();
  Profile profile = toy::quick_profile();
  profile.training.views_per_image = 2;
  profile.training.composites_per_view = 1;
  std::vector<const TrainingView*> pointers;
  pointers.reserve(views.size());
  for (const TrainingView& view : views) pointers.push_back(&view);
  const TrainingSet kept = make_training_set(pointers, set_input(profile), kKeepAll);
  const TrainingSet let_go = make_training_set(pointers, set_input(profile), [&](const TrainingView* done) {
    TrainingView& view = views[static_cast<std::size_t>(done - views.data())];
    EXPECT_FALSE(view.frame.colour.empty()) << "done twice";
    view.frame = {};
    view.mask.release();
  });
  for (const TrainingView& view : views) EXPECT_TRUE(view.frame.colour.empty()) << view.source;
  ASSERT_EQ(kept.samples.size(), let_go.samples.size());
  for (std::size_t i = 0; i < kept.samples.size(); ++i)
    EXPECT_EQ(kept.samples[i].offset, let_go.samples[i].offset) << "sample " << i;
}

/// Returns the bytes of all pixels that patches of the set read, each counted once.
std::size_t read_bytes(const TrainingSet& set) {
  std::set<std::tuple<int, int, int>> read;
  for (const auto* list : {&set.samples, &set.negative_pool}) {
    for (const TrainingSample& sample : *list) {
      const int reach = max_offset({}, sample.scale);
      for (int y = sample.y - reach; y <= sample.y + reach; ++y)
        for (int x = sample.x - reach; x <= sample.x + reach; ++x) read.emplace(sample.image, x, y);
    }
  }
  return read.size() * static_cast<std::size_t>(set.layout.pixel_stride());
}

TEST(TrainingSet, PatchesShareThePixelsThatTheyReadAndNothingElseIsHeld) {
  TrainingSet set = teach(toy::training_views(), 0.8F);
  EXPECT_GE(set.held_bytes(), read_bytes(set));
  EXPECT_LT(static_cast<double>(set.held_bytes()), 1.1 * static_cast<double>(read_bytes(set)));
  const std::size_t with_pool = set.held_bytes();
  set.negative_pool.clear();
  drop_unread_pixels({}, set);
  EXPECT_LT(set.held_bytes(), with_pool);
  EXPECT_LT(static_cast<double>(set.held_bytes()), 1.1 * static_cast<double>(read_bytes(set)));
}

TEST(TrainingSet, WhatCannotBeTaughtIsRefused) {
  const std::vector<TrainingView> good = flat_tile();
  EXPECT_THROW(teach({good[0]}, 0.7F), InputError) << "no background";
  EXPECT_THROW(teach({good[1]}, 0.7F), InputError) << "no object";
  std::vector<TrainingView> bad = good;
  bad[0].mask.setTo(0);
  EXPECT_THROW(teach(bad, 0.7F), InputError) << "empty mask";
  bad = {good[0], good[0], good[1]};
  bad[1].class_name = "other";
  EXPECT_THROW(teach(bad, 0.7F), InputError) << "two names";
  bad = good;
  bad[0].frame.depth = bad[0].frame.depth.clone();
  bad[0].frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_THROW(teach(bad, 0.7F), InputError) << "no depth";
}

}  // namespace
}  // namespace houghstream::training
