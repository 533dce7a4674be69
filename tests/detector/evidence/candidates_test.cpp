#include "detector/evidence/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/stages.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

std::vector<Candidate> candidates(const RgbdFrame& frame, const DetectionSettings& settings = {},
                                  const std::vector<std::uint32_t>& excluded_views = {}) {
  const Search search{toy::forest(), settings, fast_engine(), excluded_views};
  DetectorWorkspace workspace;
  make_working_images(search, frame, workspace);
  compute_features(search, workspace);
  find_posteriors(search, workspace);
  const std::vector<Hypothesis> hypotheses = find_hypotheses(search, workspace);
  return weigh_evidence(search, frame, hypotheses, workspace);
}

TEST(Candidates, TheStrongestOfAClassComesWithEvidenceForIt) {
  RgbdFrame frame = toy::room(77);
  const cv::Mat mask = toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  const std::vector<Candidate> found = candidates(frame);
  ASSERT_FALSE(found.empty());
  const Candidate& best = found.front();
  EXPECT_EQ(best.detection.class_id, 1);
  EXPECT_GT(best.evidence.mass_share, 0.3F);
  EXPECT_GT(best.evidence.fit.visible, 0.8F);
  EXPECT_GT(best.evidence.fit.likeness, 0.5F);
  EXPECT_GT(box_iou(best.detection.box_px, cv::Rect2f(cv::boundingRect(mask))), 0.7F);
  EXPECT_EQ(best.detection.score, score(toy::forest().classes[0].score_model, best.evidence));
}

TEST(Candidates, ExcludedViewsAreNotCompared) {
  RgbdFrame frame = toy::room(77);
  toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  std::vector<std::uint32_t> all;
  all.reserve(toy::forest().views.size());
  for (std::uint32_t v = 0; v < toy::forest().views.size(); ++v) all.push_back(v);
  const std::vector<Candidate> found = candidates(frame, {}, all);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().evidence.fit.visible, 0.0F);
}

TEST(Candidates, NoClassOffersMoreThanItMay) {
  RgbdFrame frame = toy::room(77);
  toy::put_tile(0, 80, 119.5, 0.7, frame);
  toy::put_tile(0, 240, 119.5, 0.7, frame);
  const auto stripes = [&](int max_per_class) {
    DetectionSettings settings;
    settings.voting.max_per_class = max_per_class;
    const std::vector<Candidate> found = candidates(frame, settings);
    return std::count_if(found.begin(), found.end(), [](const Candidate& c) { return c.detection.class_id == 1; });
  };
  EXPECT_GE(stripes(250), 2);
  EXPECT_EQ(stripes(1), 1);
}

TEST(AttitudeSpread, GrowsWithTheViewsOfTheClass) {
  Forest forest;
  const auto add = [&](std::uint32_t class_index, std::size_t views) {
    TrainedView view;
    view.class_index = class_index;
    forest.views.insert(forest.views.end(), views, view);
  };
  add(0, 108);
  add(1, 300);
  add(2, 2000);
  EXPECT_EQ(attitude_spread(forest, 0), 1.0F);
  EXPECT_FLOAT_EQ(attitude_spread(forest, 1), 2.0F);
  EXPECT_FLOAT_EQ(attitude_spread(forest, 2), 3.0F);
}

}  // namespace
}  // namespace houghstream
