#include "detector/evidence/camera_chroma.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/detector/evidence/template_view.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

/// Returns the image through a camera that adds so much to a* and b*, 8 bits each.
RgbdFrame with_cast(RgbdFrame frame, int a, int b) {
  cv::Mat lab;
  cv::cvtColor(frame.colour, lab, cv::COLOR_BGR2Lab);
  lab += cv::Scalar(0, a, b);
  frame.colour = cv::Mat();
  cv::cvtColor(lab, frame.colour, cv::COLOR_Lab2BGR);
  return frame;
}

/// Classes that all look like the toy's view.
Forest alike(std::size_t classes) {
  Forest forest;
  forest.scoring = Scoring::kEvidence;
  for (std::size_t i = 0; i < classes; ++i) {
    ObjectClass& object = forest.classes.emplace_back();
    object.class_id = static_cast<int>(i) + 1;
    object.name = std::string(1, static_cast<char>('a' + i));
    object.radius = 0.08F;
    forest.views.push_back(toy::template_view());
    forest.views.back().class_index = static_cast<std::uint32_t>(i);
  }
  return forest;
}

/// Returns a hypothesis of each class at the position of the toy's view.
std::vector<Hypothesis> one_of_each_class(const Forest& forest) {
  std::vector<Hypothesis> hypotheses(forest.classes.size());
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    hypotheses[i].class_index = i;
    hypotheses[i].centre_camera = {0.0F, 0.0F, toy::kDistance};
    hypotheses[i].vote_mass = 0.02F;
    hypotheses[i].weight = 1.0F;
    hypotheses[i].views = {{static_cast<std::uint32_t>(i), 1.0F}};
  }
  return hypotheses;
}

/// Returns the hypotheses that groups of classes find.
std::vector<ScoredHypothesis> weighed(const std::vector<Forest>& forests, const RgbdFrame& frame,
                                      const std::vector<ChromaPair>& reference = {}) {
  const LabFrame in_lab = toy::lab_frame(frame, frame.colour, 1.0F);
  const std::vector<ForestIndex> indices(forests.begin(), forests.end());
  std::vector<std::vector<Hypothesis>> hypotheses;
  for (const Forest& forest : forests) hypotheses.push_back(one_of_each_class(forest));
  const PatchGrid patches;
  const EvidenceSettings settings;
  const std::vector<std::uint32_t> excluded;
  std::vector<GroupHypotheses> groups;
  for (std::size_t i = 0; i < forests.size(); ++i)
    groups.push_back({{indices[i], in_lab, patches, settings, excluded}, hypotheses[i]});
  ScoringWorkspace workspace;
  return score_in_camera_colours(groups, reference, 2, workspace);
}

std::vector<ScoredHypothesis> weighed(const Forest& forest, const RgbdFrame& frame,
                                      const std::vector<ChromaPair>& reference = {}) {
  return weighed(std::vector<Forest>{forest}, frame, reference);
}

std::vector<ChromaPair> seen_with_cast(double a, double b) {
  std::vector<ChromaPair> pairs;
  for (const auto& [name, chroma] : std::initializer_list<std::pair<const char*, Eigen::Vector2d>>{
           {"p", {30.0, 20.0}}, {"q", {-15.0, 25.0}}, {"r", {5.0, -25.0}}, {"s", {0.0, 5.0}}, {"t", {-5.0, 40.0}}}) {
    ChromaPair& pair = pairs.emplace_back();
    pair.class_name = name;
    pair.model = chroma;
    pair.measured = chroma + Eigen::Vector2d(a, b);
    pair.lightness = 100.0;
    pair.probability = 0.95;
  }
  return pairs;
}

constexpr int kA = 8;
constexpr int kB = 30;

TEST(CameraChroma, ACastThatTheCameraIsKnownForSpeaksAgainstNobody) {
  const RgbdFrame plain = toy::training_views().front().frame;
  const RgbdFrame cast = with_cast(plain, kA, kB);
  const Forest forest = alike(1);
  const float as_taught = weighed(forest, plain).front().detection.score;
  const ScoredHypothesis before = weighed(forest, cast).front();
  const ScoredHypothesis after = weighed(forest, cast, seen_with_cast(kA, kB)).front();
  EXPECT_LT(before.detection.score, as_taught - 0.01F) << "alone in a frame nothing is learnt";
  EXPECT_GT(after.detection.score, 0.5F * (before.detection.score + as_taught));
  EXPECT_LT(after.evidence.fit.mean_chroma_distance, 0.5F * before.evidence.fit.mean_chroma_distance);
  EXPECT_EQ(after.evidence.fit.visible_fraction, before.evidence.fit.visible_fraction);
}

TEST(CameraChroma, ObjectsOfAFrameTellTheCastToEachOther) {
  const RgbdFrame cast = with_cast(toy::training_views().front().frame, kA, kB);
  const float alone = weighed(alike(1), cast).front().detection.score;
  for (const ScoredHypothesis& together : weighed(alike(5), cast)) EXPECT_GT(together.detection.score, alone + 0.01F);
}

TEST(CameraChroma, InWhichGroupAnObjectIsMakesNoDifference) {
  const RgbdFrame cast = with_cast(toy::training_views().front().frame, kA, kB);
  const std::vector<ScoredHypothesis> together = weighed(alike(5), cast);
  const Forest first = alike(2);
  Forest second = alike(5);
  second.classes.erase(second.classes.begin(), second.classes.begin() + 2);
  second.views.erase(second.views.begin(), second.views.begin() + 2);
  for (ViewTemplate& view : second.views) view.class_index -= 2;
  const std::vector<ScoredHypothesis> in_groups = weighed(std::vector<Forest>{first, second}, cast);
  ASSERT_EQ(in_groups.size(), together.size());
  for (std::size_t i = 0; i < together.size(); ++i) {
    EXPECT_EQ(in_groups[i].detection.class_name, together[i].detection.class_name);
    EXPECT_EQ(in_groups[i].detection.score, together[i].detection.score) << i;
  }
}

TEST(CameraChroma, AKnownCastDoesNotMakeAnotherColourRight) {
  const RgbdFrame plain = toy::training_views().front().frame;
  const float as_taught = weighed(alike(1), plain).front().detection.score;
  EXPECT_LT(weighed(alike(1), with_cast(plain, -30, -30), seen_with_cast(kA, kB)).front().detection.score, as_taught);
}

TEST(CameraChroma, InAnImageWithoutColoursChromaSaysNothing) {
  RgbdFrame grey = toy::training_views().front().frame;
  cv::Mat lightness;
  cv::cvtColor(grey.colour, lightness, cv::COLOR_BGR2GRAY);
  grey.colour = cv::Mat();
  cv::cvtColor(lightness, grey.colour, cv::COLOR_GRAY2BGR);
  const ScoredHypothesis seen = weighed(alike(1), grey).front();
  EXPECT_LT(seen.evidence.fit.mean_chroma_distance, 0.1F);
  EXPECT_LT(seen.evidence.fit.hue_mismatch, 0.05F);
}

}  // namespace
}  // namespace houghstream
