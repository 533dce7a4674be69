#include "tools/evaluate/in_process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "detector/training/forest_trainer.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "tests/detector/toy_data.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

const Forest& toy_forest() {
  static const Forest forest = training::train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  return forest;
}

/// Returns a plate of the tiles' size.
std::map<std::string, Mesh> plates() {
  Mesh mesh;
  mesh.vertices = {{-0.06F, -0.06F, 0}, {0.06F, -0.06F, 0}, {0.06F, 0.06F, 0}, {-0.06F, 0.06F, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return {{"stripes", mesh}, {"rings", mesh}};
}

/// Makes a scene of two images with both tiles.
BopScene two_tiles(const std::string& name) {
  const std::filesystem::path folder = fresh_folder(name);
  BopWriter writer(folder);
  for (const std::uint64_t seed : {77, 78}) {
    RgbdFrame frame = toy::background(seed);
    toy::put_tile(0, 90, 119.5, 0.7, frame);
    toy::put_tile(1, 230, 119.5, 0.7, frame);
    writer.add(frame, {}, {});
  }
  writer.finish();
  return BopScene(folder);
}

DetectionSettings settings_from(float threshold) {
  DetectionSettings settings;
  settings.evidence.threshold = threshold;
  return settings;
}

std::vector<EvaluatedFrame> run(const BopScene& scene, float threshold, const PublishingRules& rules) {
  std::vector<EvaluatedFrame> frames = read_ground_truth(scene, {});
  InProcess({toy_forest()}, settings_from(threshold), detector_search, plates(), rules).run(scene, frames);
  return frames;
}

int count_poses(const std::optional<ObjectPoses>& poses) {
  return static_cast<int>(std::count_if(poses->poses.begin(), poses->poses.end(),
                                        [](const ObjectPose& pose) { return pose.T_camera_object.has_value(); }));
}

TEST(InProcess, SaysFromWhichScoreOnDetectionsAreListed) {
  PublishingRules rules;
  rules.score = 0.5F;
  const auto ranked_from = [&](float threshold) {
    return InProcess({toy_forest()}, settings_from(threshold), detector_search, plates(), rules).ranked_from();
  };
  EXPECT_EQ(ranked_from(0.75F), 0.5F) << "what would be sent is listed in any case";
  EXPECT_EQ(ranked_from(0.1F), 0.1F);
  rules.candidates_from = 0.2F;
  EXPECT_EQ(ranked_from(0.75F), 0.2F);
}

TEST(InProcess, PosesOfWeakDetectionsAreKnownButNotPublished) {
  const BopScene scene = two_tiles("in_process_weak");
  PublishingRules rules;
  rules.score = 0.5F;
  set_min_quality(0.0F, rules.pose);
  rules.pose.min_score = 0.0F;
  const std::vector<EvaluatedFrame> ranked = run(scene, 0.0F, rules);
  const std::vector<EvaluatedFrame> usual = run(scene, 0.5F, rules);
  ASSERT_EQ(ranked.size(), 2U);
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const std::size_t strong = usual[i].detections->detections.size();
    const std::size_t all = ranked[i].detections->detections.size();
    ASSERT_GT(strong, 0U);
    ASSERT_GT(all, strong);
    ASSERT_EQ(ranked[i].poses->poses.size(), all) << "one for each detection";
    for (std::size_t k = 0; k < all; ++k) {
      const ObjectPose& published = ranked[i].poses->poses[k];
      EXPECT_EQ(published.detection_index, static_cast<int>(k));
      EXPECT_EQ(ranked[i].unfiltered_poses->poses[k].detection_index, static_cast<int>(k));
      if (k >= strong) {
        EXPECT_EQ(published.status, PoseStatus::kLowScore);
        EXPECT_EQ(published.class_name, ranked[i].detections->detections[k].class_name);
        continue;
      }
      const ObjectPose& same = usual[i].poses->poses[k];
      EXPECT_EQ(published.status, same.status);
      ASSERT_EQ(published.T_camera_object.has_value(), same.T_camera_object.has_value());
      if (!same.T_camera_object) continue;
      EXPECT_EQ(published.T_camera_object->matrix(), same.T_camera_object->matrix());
    }
    EXPECT_GT(count_poses(ranked[i].poses), 0);
    EXPECT_GT(count_poses(ranked[i].unfiltered_poses), count_poses(ranked[i].poses));
    EXPECT_EQ(count_poses(usual[i].unfiltered_poses), count_poses(usual[i].poses));
  }
}

TEST(InProcess, PosesOfLowQualityAreKnownButNotPublished) {
  const BopScene scene = two_tiles("in_process_quality");
  PublishingRules rules;
  rules.score = 0.5F;
  set_min_quality(0.0F, rules.pose);
  const std::vector<EvaluatedFrame> all = run(scene, 0.5F, rules);
  set_min_quality(1.0F, rules.pose);
  const std::vector<EvaluatedFrame> none = run(scene, 0.5F, rules);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(count_poses(none[i].poses), 0);
    EXPECT_EQ(count_poses(none[i].unfiltered_poses), count_poses(all[i].poses));
    EXPECT_NE(none[i].poses->poses[0].status, PoseStatus::kValid) << "it says why";
    EXPECT_EQ(none[i].poses->poses[0].quality, all[i].poses->poses[0].quality);
  }
}

TEST(InProcess, CandidatesHavePosesThatArePublishedByALimitOfTheirOwn) {
  const BopScene scene = two_tiles("in_process_candidates");
  PublishingRules rules{0.5F, 0.0F, {}};
  rules.pose.min_score = 0.0F;
  rules.pose.min_publication_probability = 0.0F;
  set_min_quality(0.0F, rules.pose);
  const std::vector<EvaluatedFrame> all = run(scene, 0.5F, rules);
  rules.pose.quality.min_candidate_quality = 1.0F;
  const std::vector<EvaluatedFrame> none = run(scene, 0.5F, rules);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<Detection>& found = all[i].detections->detections;
    const auto reported = std::count_if(found.begin(), found.end(), [](const auto& it) { return it.reported; });
    ASSERT_GT(reported, 0);
    ASSERT_GT(found.size(), static_cast<std::size_t>(reported)) << "whatever was asked to be found";
    EXPECT_GT(count_poses(all[i].poses), count_poses(none[i].poses));
    EXPECT_LE(count_poses(none[i].poses), reported);
  }
}

TEST(InProcess, AClassIsReportedFromItsOwnScoreOn) {
  const BopScene scene = two_tiles("in_process_classes");
  PublishingRules rules{0.5F, 0.0F, {}};
  rules.class_scores = {{"stripes", 1.0F}};
  rules.pose.min_score = 0.0F;
  set_min_quality(0.0F, rules.pose);
  rules.pose.quality.min_candidate_quality = 1.0F;
  for (const EvaluatedFrame& frame : run(scene, 0.5F, rules)) {
    int rings = 0;
    int stripes = 0;
    for (std::size_t i = 0; i < frame.detections->detections.size(); ++i) {
      const Detection& detection = frame.detections->detections[i];
      ASSERT_EQ(frame.poses->poses[i].class_name, detection.class_name) << "each pose in its detection's place";
      EXPECT_EQ(frame.poses->poses[i].detection_index, static_cast<int>(i));
      rings += detection.class_name == "rings" && detection.reported ? 1 : 0;
      stripes += detection.class_name == "stripes" && detection.reported ? 1 : 0;
      EXPECT_FALSE(detection.class_name == "stripes" && frame.poses->poses[i].T_camera_object.has_value());
    }
    EXPECT_EQ(stripes, 0);
    EXPECT_GT(rings, 0);
  }
}

TEST(InProcess, TimesAreThoseOfASearchForWhatIsPublished) {
  const BopScene scene = two_tiles("in_process_times");
  const std::vector<EvaluatedFrame> frames = run(scene, 0.0F, {0.5F, 0.2F, {}});
  std::set<std::string> stages;
  for (const StageTime& stage : frames[0].poses->stages)
    EXPECT_TRUE(stages.insert(stage.stage).second) << stage.stage << " twice";
  EXPECT_EQ(stages.count("detect.votes"), 1U);
  EXPECT_EQ(stages.count("pose.registration"), 1U);
}

TEST(InProcess, WithoutModelsNobodyLooksForPoses) {
  const BopScene scene = two_tiles("in_process_models");
  std::vector<EvaluatedFrame> frames = read_ground_truth(scene, {});
  frames.erase(frames.begin());
  InProcess({toy_forest()}, settings_from(0.5F), detector_search, {}, {}).run(scene, frames);
  ASSERT_EQ(frames.size(), 1U) << "those that were asked for";
  EXPECT_EQ(frames[0].detections->frame.utime, frames[0].utime);
  EXPECT_FALSE(frames[0].poses.has_value());
  EXPECT_FALSE(frames[0].unfiltered_poses.has_value());
}

}  // namespace
}  // namespace houghstream
