#include "tools/finder/stored_quality.hpp"

#include <gtest/gtest.h>

#include "tests/test_files.hpp"
#include "tools/finder/stored_precision.hpp"

namespace houghstream {
namespace {

QualitySettings learnt() {
  QualitySettings settings;
  settings.bias = -1.25;
  double value = 0.0;
  for (const auto term : kQualityTerms) {
    settings.weights.*term = value += 0.1;
    settings.mean_of_correct.*term = -(value / 3.0);
  }
  settings.presence = {1.5, 0.25, -0.5};
  settings.min_quality = 0.9F;
  return settings;
}

/// A mug whose quality is known, and a bowl of which nothing was learnt.
store::ObjectStore store_with(const nlohmann::json& quality) {
  store::ObjectStore objects;
  objects.folder = "/some/store";
  objects.objects = {{1, "mug", "mug.ply", true, 12, "resting", Eigen::Vector3f::Zero(), quality},
                     {2, "bowl", "bowl.ply", true, 12, "resting", Eigen::Vector3f::Zero(), nullptr}};
  return objects;
}

TEST(StoredQuality, ComesBackFromJsonAsItWas) {
  const auto json = nlohmann::json::parse(quality_to_json(learnt()).dump());
  QualitySettings others;
  others.min_quality = 0.35F;
  const std::map<std::string, QualitySettings> read = stored_quality(store_with(json), others);
  ASSERT_EQ(read.size(), 1U) << "nothing was learnt of the bowl";
  const QualitySettings& mug = read.at("mug");
  EXPECT_EQ(mug.bias, learnt().bias);
  for (const auto term : kQualityTerms) {
    EXPECT_EQ(mug.weights.*term, learnt().weights.*term);
    EXPECT_EQ(mug.mean_of_correct.*term, learnt().mean_of_correct.*term);
  }
  EXPECT_EQ(mug.presence.bias, learnt().presence.bias);
  EXPECT_EQ(mug.presence.score_weight, learnt().presence.score_weight);
  EXPECT_EQ(mug.presence.quality_weight, learnt().presence.quality_weight);
  EXPECT_EQ(mug.min_quality, 0.35F) << "the threshold is its reader's";
}

TEST(StoredQuality, AStoreThatKnowsNothingOfPresenceIsReadWithThatOfOthers) {
  nlohmann::json json = quality_to_json(learnt());
  json.erase("presence");
  QualitySettings others;
  others.presence.quality_weight = 0.125;
  EXPECT_EQ(stored_quality(store_with(json), others).at("mug").presence.quality_weight, 0.125);
}

TEST(StoredQuality, PosesAreMadeWithTheShapeSymmetriesThatTheStoreKnows) {
  store::ObjectStore objects = store_with(quality_to_json(learnt()));
  objects.objects[1].shape_symmetry = ShapeSymmetry{};
  objects.objects[1].shape_symmetry->symmetries.continuous.push_back({});
  const PoseSettings settings = pose_settings_of({}, objects, std::nullopt);
  EXPECT_EQ(settings.model.shape_symmetries.count("mug"), 0U);
  EXPECT_EQ(settings.model.shape_symmetries.at("bowl").symmetries.continuous.size(), 1U);
}

TEST(StoredQuality, APrecisionChoosesTheQualityOfEachObject) {
  store::ObjectStore objects = store_with(quality_to_json(learnt()));
  for (store::StoredObject& object : objects.objects) object.practice = store::PracticeRecord();
  objects.objects[0].practice->qualities = {{0.8, 90, 0}, {0.3, 95, 40}};
  PoseSettings settings = pose_settings_of({}, objects, std::nullopt);
  set_precision(0.95, objects, settings);
  EXPECT_EQ(class_quality_of(settings, "mug").min_quality, 0.8F);
  EXPECT_EQ(class_quality_of(settings, "mug").min_candidate_quality, 0.8F) << "of candidates as well";
  EXPECT_EQ(class_quality_of(settings, "mug").bias, learnt().bias);
  EXPECT_EQ(class_quality_of(settings, "bowl").min_quality, kStoreQuality) << "nothing was found of it";
  objects.objects[1].practice->qualities = {{0.7, 60, 1}};
  set_precision(0.95, objects, settings);
  EXPECT_EQ(class_quality_of(settings, "bowl").min_quality, 0.7F) << "whose weights are the common ones";
  EXPECT_EQ(with_precision({}, objects, std::nullopt).class_thresholds.size(), 0U);
  objects.objects[0].practice->scores = {{0.6, 90, 0}};
  EXPECT_EQ(with_precision({}, objects, 0.95).class_thresholds.at("mug"), 0.6F);
}

TEST(StoredQuality, TermsAreHeldByTheirNames) {
  nlohmann::json json = quality_to_json(learnt());
  EXPECT_EQ(json["weights"]["outline"], learnt().weights.outline);
  EXPECT_EQ(json["typical"]["print"], learnt().mean_of_correct.texture);
}

/// One line that names the store, the object and `part`.
void expect_refused(const nlohmann::json& json, const std::string& part) {
  const std::string error = error_of([&] { stored_quality(store_with(json), {}); });
  for (const std::string& named : {std::string("/some/store/store.json"), std::string("mug"), part})
    EXPECT_NE(error.find(named), std::string::npos) << named << " in: " << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

TEST(StoredQuality, AMissingOrUnknownNumberIsRefusedNamingTheStore) {
  const nlohmann::json whole = quality_to_json(learnt());
  nlohmann::json json = whole;
  json["weights"]["agreement"] = 1.0;
  expect_refused(json, "has 9 terms, expected 8");
  json["weights"].erase("print");  // of another version
  expect_refused(json, "has no 'print': it was learnt from other terms; hs-teach practise recalibrates it");
  json = whole;
  json.erase("typical");
  expect_refused(json, "'typical'");
  json = whole;
  json.erase("bias");
  expect_refused(json, "'bias'");
  json = whole;
  json["typical"]["visible"] = "much";
  expect_refused(json, "'visible'");
  json = whole;
  json["presence"].erase("of_score");
  expect_refused(json, "'presence'");
  json["presence"]["of_colour"] = 1.0;
  expect_refused(json, "'of_score'");
  json = whole;
  json["weights"] = 3;
  expect_refused(json, "'weights'");
}

}  // namespace
}  // namespace houghstream
