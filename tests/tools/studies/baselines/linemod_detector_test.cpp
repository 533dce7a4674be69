#include "tools/studies/baselines/linemod_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "tests/detector/toy_data.hpp"
#include "tools/studies/baselines/linemod_tuning.hpp"
#include "tools/studies/baselines/scaled_view.hpp"

namespace houghstream {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

LinemodTemplateSettings quick_templates() {
  LinemodTemplateSettings settings;
  settings.features = 31;
  settings.min_distance = 0.5F;
  settings.max_distance = 1.2F;
  return settings;
}

/// Returns one view of each kind of tile: the backgrounds differ, the tiles do not.
std::vector<TrainingView> toy_views() {
  const std::vector<TrainingView> all = toy::training_views();
  return {all[0], all[1]};
}

const LinemodDetector& toy_detector() {
  static const LinemodDetector detector(toy_views(), quick_templates(), {});
  return detector;
}

Detections find_tile(int kind, double distance, cv::Point2d centre, cv::Rect& box_px) {
  RgbdFrame frame = toy::background(9);
  frame.id.utime = 17;
  box_px = cv::boundingRect(toy::put_upright_tile(kind, centre.x, centre.y, distance, frame));
  return toy_detector().detect(frame);
}

TEST(LinemodDetector, FindsATaughtObjectAtTwoDistances) {
  for (const double distance : {0.6, 1.0}) {
    cv::Rect box_px;
    const Detections found = find_tile(0, distance, {110, 130}, box_px);
    ASSERT_FALSE(found.detections.empty()) << distance;
    const auto& all = found.detections;
    const auto best = std::find_if(all.begin(), all.end(), [](const Detection& d) { return d.class_id == 1; });
    ASSERT_NE(best, all.end());
    EXPECT_EQ(best->class_name, "stripes");
    EXPECT_GT(best->score, 0.8F);
    EXPECT_LE(best->score, 1.0F);
    EXPECT_GT(box_iou(best->box_px, cv::Rect2f(box_px)), 0.7F) << distance;
    EXPECT_NEAR(best->centre_camera.z(), distance, 0.15 * distance);
    EXPECT_EQ(found.frame.utime, 17);
    ASSERT_EQ(found.stages.size(), 2U);
    EXPECT_EQ(found.stages[0].stage, "linemod.match");
  }
}

TEST(LinemodDetector, FindsAnObjectAtTheEdgeOfTheFrame) {
  cv::Rect box_px;
  const Detections found = find_tile(0, 0.6, {290, 208}, box_px);
  const auto is_there = [&](const Detection& d) {
    return d.class_id == 1 && box_iou(d.box_px, cv::Rect2f(box_px)) > 0.7F;
  };
  EXPECT_TRUE(std::any_of(found.detections.begin(), found.detections.end(), is_there)) << box_px;
}

TEST(LinemodDetector, StrongestComeFirstAndRepeatsOfAClassAreGone) {
  cv::Rect box_px;
  const std::vector<Detection> found = find_tile(1, 0.7, {160, 120}, box_px).detections;
  ASSERT_FALSE(found.empty());
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE(found[j].score, found[i].score);
      const bool same_class = found[i].class_id == found[j].class_id;
      EXPECT_TRUE(!same_class || box_iou(found[i].box_px, found[j].box_px) <= 0.5F);
    }
  }
}

TEST(LinemodDetector, AFrameWithoutAnythingGivesNoDetection) {
  RgbdFrame frame = toy::background(9);
  frame.colour.setTo(cv::Scalar(90, 90, 90));
  frame.depth.setTo(kNone);
  EXPECT_TRUE(toy_detector().detect(frame).detections.empty());
}

TEST(LinemodDetector, TheSameWhateverTheNumberOfThreads) {
  LinemodTemplateSettings one = quick_templates();
  one.threads = 1;
  RgbdFrame frame = toy::background(9);
  toy::put_upright_tile(0, 110, 130, 0.8, frame);
  const Detections a = LinemodDetector(toy_views(), one, {}).detect(frame);
  const Detections b = toy_detector().detect(frame);
  ASSERT_EQ(a.detections.size(), b.detections.size());
  for (std::size_t i = 0; i < a.detections.size(); ++i) {
    EXPECT_EQ(a.detections[i].score, b.detections[i].score);
    EXPECT_EQ(a.detections[i].box_px, b.detections[i].box_px);
  }
}

TEST(LinemodDetector, ViewsOfWhichNoTemplateCanBeMadeAreCounted) {
  std::vector<TrainingView> views = toy_views();
  const int steps = toy_detector().training().templates / 2;
  views.resize(4, views[0]);
  views[2].mask = cv::Mat(views[2].mask.size(), CV_8UC1, cv::Scalar(0));
  views[3].frame.depth = cv::Mat(views[3].mask.size(), CV_32FC1, cv::Scalar(kNone));
  const LinemodDetector detector(views, quick_templates(), {});
  EXPECT_EQ(detector.training().refused_views, 2);
  EXPECT_EQ(detector.training().templates, 2 * steps);
  EXPECT_EQ(detector.training().refused_templates, 2 * steps);
  views.erase(views.begin(), views.begin() + 2);
  EXPECT_THROW(LinemodDetector(views, quick_templates(), {}), InputError);
}

TEST(LinemodDetector, TooSmallTemplatesAreCounted) {
  LinemodTemplateSettings far = quick_templates();
  far.max_distance = 20.0F;
  const LinemodDetector detector(toy_views(), far, {});
  EXPECT_GT(detector.training().templates, 0);
  EXPECT_GT(detector.training().refused_templates, 0);
  EXPECT_EQ(detector.training().refused_views, 0);
}

TEST(LinemodDetector, BadSettingsAndViewsAreRefused) {
  const auto refused = [](const LinemodTemplateSettings& settings, const LinemodSelection& selection,
                          const std::vector<TrainingView>& views) {
    EXPECT_THROW(LinemodDetector(views, settings, selection), InputError);
  };
  LinemodTemplateSettings settings = quick_templates();
  settings.features = 64;
  refused(settings, {}, toy_views());
  settings = quick_templates();
  settings.distance_step = 1.0F;
  refused(settings, {}, toy_views());
  settings = quick_templates();
  settings.max_distance = 0.4F;
  refused(settings, {}, toy_views());
  LinemodSelection selection;
  selection.match_threshold = kNone;
  refused(quick_templates(), selection, toy_views());
  std::vector<TrainingView> behind = toy_views();
  behind[0].T_camera_object.translation().z() = -1.0;
  refused(quick_templates(), {}, behind);
  std::vector<TrainingView> torn = toy_views();
  torn[1].mask = torn[1].mask(cv::Rect(0, 0, 10, 10));
  refused(quick_templates(), {}, torn);
}

TEST(DepthAgrees, WithinItsShareOfTheDistanceAndWhereThereIsNone) {
  LinemodTemplate shape;
  shape.distance = 1.0F;
  shape.samples = {{{0, 0}, 1.0F}, {{1, 0}, 1.0F}, {{2, 0}, 1.0F}};
  const LinemodMatch match{90.0F, &shape, {1, 1}};
  cv::Mat depth(4, 8, CV_32FC1, cv::Scalar(1.05));
  EXPECT_TRUE(depth_agrees(match, depth, 0.1F));
  EXPECT_FALSE(depth_agrees(match, depth, 0.04F));
  depth.at<float>(1, 1) = 9.0F;  // one of three does not move the median
  EXPECT_TRUE(depth_agrees(match, depth, 0.1F));
  depth.setTo(kNone);
  EXPECT_TRUE(depth_agrees(match, depth, 0.1F));
  const LinemodMatch outside{90.0F, &shape, {100, 100}};
  EXPECT_TRUE(depth_agrees(outside, depth, 0.1F));
}

TEST(SelectDetections, ChecksDepthOnlyWhereItIsAskedTo) {
  LinemodTemplate shape;
  shape.class_id = 1;
  shape.distance = 1.0F;
  shape.box_px = {-2, -2, 20, 20};
  shape.samples = {{{0, 0}, 1.0F}};
  const RgbdFrame far = toy::background(9);
  const std::vector<LinemodMatch> matches = {{90.0F, &shape, {0, 0}}, {50.0F, &shape, {200, 100}}};
  LinemodSelection selection;
  const std::vector<Detection> found = select_detections(matches, far, selection);
  ASSERT_EQ(found.size(), 1U) << "one is below the threshold";
  EXPECT_EQ(found[0].box_px, cv::Rect2f(0, 0, 18, 18)) << "inside the frame";
  selection.check_depth = true;
  EXPECT_TRUE(select_detections(matches, far, selection).empty());
}

TEST(ScaledView, AnotherCameraSeesItInItsOwnSizeAndAsFarAway) {
  const TrainingView view = toy_views()[0];
  const std::optional<ScaledView> same = scale_view(view, 0.7);
  const std::optional<ScaledView> longer = scale_view(view, 1.4, 2.0 * view.frame.camera.fx);
  ASSERT_TRUE(same && longer);
  EXPECT_EQ(longer->view_scale, same->view_scale);
  EXPECT_EQ(longer->colour.size(), same->colour.size());
  EXPECT_EQ(longer->distance, 1.4);
}

TEST(ScaledView, ImagesGrowAndDepthIsShifted) {
  const TrainingView view = toy_views()[0];  // 0.7 m away
  const cv::Rect box = cv::boundingRect(view.mask);
  const std::optional<ScaledView> near = scale_view(view, 0.35);
  ASSERT_TRUE(near);
  const cv::Rect near_box = cv::boundingRect(near->mask);
  EXPECT_NEAR(near_box.width, 2 * box.width, 2);
  EXPECT_EQ(near->colour.cols % 2 + near->colour.rows % 2, 0);
  EXPECT_EQ(near->colour.size(), near->depth_mm.size());
  const cv::Point middle = (near_box.tl() + near_box.br()) / 2;
  const float there = view.frame.depth.at<float>((box.tl() + box.br()) / 2);
  EXPECT_NEAR(near->depth_mm.at<std::uint16_t>(middle), (there - 0.35F) * 1000.0F, 3.0);
  EXPECT_EQ(near->depth_mm.at<std::uint16_t>(0, 0), 0) << "none outside the mask";
  EXPECT_NEAR(near->origin_px.x, near_box.x + near_box.width / 2.0, 2.0);
}

TEST(LinemodImages, AreWholeStepsAndAlignedAndHoldTheLargestTemplate) {
  const RgbdFrame frame = toy::background(9);  // 320x240
  const std::vector<cv::Mat> same = linemod_images(frame, {200, 100});
  EXPECT_EQ(same[0].size(), cv::Size(320, 240)) << "nothing to add";
  for (const cv::Mat& image : linemod_images(frame, {300, 239})) {
    EXPECT_EQ(image.cols % 160, 0);
    EXPECT_EQ(image.rows % 80, 0);
    EXPECT_GE(image.cols, 380);
    EXPECT_GE(image.rows, 319);
    EXPECT_TRUE(image.isContinuous());
  }
}

TEST(TuneLinemod, TriesSettingsOnViewsThatAreNotTaught) {
  LinemodTemplateSettings settings = quick_templates();
  settings.max_distance = 0.6F;
  std::vector<TrainingView> views = toy::training_views();
  const ComposedExamples examples = compose_examples(views, 0.5F, 0.6F, 8);
  EXPECT_EQ(examples.taught.size(), 18U) << "24 views of two classes, one in four shown";
  EXPECT_EQ(examples.frames.size(), 8U);
  EXPECT_EQ(examples.truth.size(), 8U);
  EXPECT_EQ(examples.class_names, (std::set<std::string>{"rings", "stripes"}));
  views.erase(std::remove_if(views.begin(), views.end(), [](const TrainingView& v) { return v.class_id == 0; }),
              views.end());
  EXPECT_THROW(tune_linemod(views, settings, {}, 8, [](const LinemodTrial&) {}), InputError);
}

TEST(TuneLinemod, ReportsEachTrial) {
  LinemodTemplateSettings settings = quick_templates();
  settings.max_distance = 0.6F;
  int trials = 0;
  double best = 0.0;
  tune_linemod(toy::training_views(), settings, {}, 8, [&](const LinemodTrial& trial) {
    ++trials;
    best = std::max(best, trial.auc);
    EXPECT_GT(trial.template_count, 0);
    EXPECT_LE(trial.best_f1, 1.0);
  });
  EXPECT_EQ(trials, 60);
  EXPECT_GT(best, 0.4);
}

}  // namespace
}  // namespace houghstream
