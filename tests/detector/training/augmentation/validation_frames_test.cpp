#include "detector/training/augmentation/validation_frames.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/detector/toy_data.hpp"

namespace houghstream::training {
namespace {

struct TilesAndBackgrounds {
  std::vector<TrainingView> views = toy::training_views();
  std::vector<const TrainingView*> objects;
  TilesAndBackgrounds() {
    for (const TrainingView& view : views) {
      if (view.class_id != 0) objects.push_back(&view);
    }
  }
};

constexpr ComposedThings kThings = {4, 2, 0};

/// Composes frames by the camera used for teaching: another one's depth has other holes and is shifted by a few pixels.
ValidationFrame compose(const TilesAndBackgrounds& toys, std::uint64_t seed, double occluded_fraction,
                        double camera_fraction = 0.0) {
  TrainingSettings settings = toy::quick_profile().training;
  settings.occluded_fraction = occluded_fraction;
  settings.camera_fraction = camera_fraction;
  Random random(seed);
  return make_validation_frame(toys.objects, toy::background(9), kThings, settings, random);
}

TEST(ValidationFrames, NameWhatTheyShowAndWhere) {
  const TilesAndBackgrounds toys;
  const RgbdFrame room = toy::background(9);
  int objects = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const ValidationFrame validation = compose(toys, seed, 0.0);
    EXPECT_EQ(validation.frame.colour.size(), room.colour.size());
    for (const ValidationFrame::Object& object : validation.objects) {
      ++objects;
      EXPECT_EQ(object.class_id, toys.objects.at(object.view.value())->class_id);
      EXPECT_GT(object.visible_fraction, 0.0);
      EXPECT_LE(object.visible_fraction, 1.0);
      ASSERT_FALSE(object.box_visible_px.empty());
      const cv::Point middle = (object.box_visible_px.tl() + object.box_visible_px.br()) / 2;
      if (object.visible_fraction == 1.0) {
        EXPECT_LT(validation.frame.depth.at<float>(middle), room.depth.at<float>(middle) - 0.05F);
      }
    }
  }
  EXPECT_GT(objects, 20);
}

TEST(ValidationFrames, OccludersLeaveLessOfTheObjects) {
  const TilesAndBackgrounds toys;
  double open = 0.0;
  double occluded = 0.0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (const auto& object : compose(toys, seed, 0.0).objects) open += object.visible_fraction;
    for (const auto& object : compose(toys, seed, 1.0).objects) occluded += object.visible_fraction;
  }
  EXPECT_LT(occluded, 0.85 * open);
}

TEST(ValidationFrames, AsManyLookAlikesAndStrangersOfEachSortAsAskedForStandThereToo) {
  const TilesAndBackgrounds toys;
  EXPECT_EQ(compose(toys, 1, 0.0).distractor_views.size(), 2U * 2U);
  TrainingSettings settings = toy::quick_profile().training;
  Random random(1);
  const ComposedThings things{0, 0, 4};
  const ValidationFrame hard_negatives =
      make_validation_frame(toys.objects, toy::background(9), things, settings, random);
  EXPECT_EQ(hard_negatives.distractor_views.size(), 4U + 2U * 4U);  // each of the second sort is made of two views
  EXPECT_TRUE(hard_negatives.objects.empty());
}

/// Returns the width over height of what stands before the room, which is flat.
std::vector<double> widths_of_things(const cv::Mat& depth, const cv::Mat& room) {
  constexpr float kBefore_m = 0.1F;
  constexpr int kMinPixels = 100;
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centroids;
  std::vector<double> widths;
  const int count = cv::connectedComponentsWithStats(depth < room - kBefore_m, labels, stats, centroids);
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) < kMinPixels) continue;
    widths.push_back(static_cast<double>(stats.at<int>(i, cv::CC_STAT_WIDTH)) / stats.at<int>(i, cv::CC_STAT_HEIGHT));
  }
  return widths;
}

TEST(ValidationFrames, AStrangerIsNarrowerOrWiderThanAnyObjectOrHasItsShape) {
  const TilesAndBackgrounds toys;  // all are square
  const RgbdFrame room = toy::background(9);
  TrainingSettings settings = toy::quick_profile().training;
  settings.occluded_fraction = 0.0;
  settings.depth_error = {};
  settings.camera_fraction = 0.0;
  int other = 0;
  int square = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const ValidationFrame frame = make_validation_frame(toys.objects, room, {0, 0, 1}, settings, random);
    for (const double width : widths_of_things(frame.frame.depth, room.depth)) {
      if (width < 0.75 || width > 1.35) ++other;
      if (width > 0.85 && width < 1.18) ++square;
    }
  }
  EXPECT_GE(other, 15);
  EXPECT_GE(square, 5);
}

TEST(ValidationFrames, AnotherCameraChangesTheImageAndNotTheTruth) {
  const TilesAndBackgrounds toys;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const ValidationFrame same = compose(toys, seed, 0.0, 0.0);
    const ValidationFrame other = compose(toys, seed, 0.0, 1.0);
    EXPECT_GT(cv::norm(same.frame.colour, other.frame.colour, cv::NORM_INF), 0.0);
    ASSERT_EQ(same.objects.size(), other.objects.size());
    for (std::size_t i = 0; i < same.objects.size(); ++i) {
      EXPECT_EQ(same.objects[i].view, other.objects[i].view);
      EXPECT_EQ(same.objects[i].box_visible_px, other.objects[i].box_visible_px);
      EXPECT_EQ(same.objects[i].visible_fraction, other.objects[i].visible_fraction);
    }
    EXPECT_EQ(same.distractor_views, other.distractor_views);
  }
}

TEST(ValidationFrames, TheRoomAndTheViewsStayAsTheyAre) {
  const TilesAndBackgrounds toys;
  const TilesAndBackgrounds untouched;
  const RgbdFrame room = toy::background(9);
  const cv::Mat colour = room.colour.clone();
  TrainingSettings settings = toy::quick_profile().training;
  Random random(1);
  make_validation_frame(toys.objects, room, kThings, settings, random);
  EXPECT_EQ(cv::norm(colour, room.colour, cv::NORM_INF), 0.0);
  for (std::size_t v = 0; v < toys.objects.size(); ++v) {
    const cv::Mat& view = toys.objects[v]->frame.colour;
    EXPECT_EQ(cv::norm(view, untouched.objects[v]->frame.colour, cv::NORM_INF), 0.0) << "view " << v;
    const cv::Mat mask = toys.objects[v]->mask;
    EXPECT_EQ(cv::norm(toys.objects[v]->frame.depth, untouched.objects[v]->frame.depth, cv::NORM_INF, mask), 0.0)
        << "view " << v;
  }
}

}  // namespace
}  // namespace houghstream::training
