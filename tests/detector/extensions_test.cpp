#include "detector/extensions.hpp"

#include <gtest/gtest.h>

#include "detector/features/features.hpp"
#include "detector/profiles.hpp"
#include "detector/training/forest_trainer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

// This program has none.

std::string refusal(const FeatureSettings& settings) {
  try {
    require_extensions(settings, "a.forest");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Extensions, TheProductsProfilesNeedNone) {
  for (const char* name : {"paper", "realtime"}) EXPECT_EQ(refusal(make_profile(name).features), "") << name;
}

TEST(Extensions, WhatIsMissingIsNamedWithWhoNeedsItAndWhoHasIt) {
  const std::string scales = refusal(make_profile("gall").features);
  EXPECT_NE(scales.find("a.forest: searches several sizes of the image"), std::string::npos) << scales;
  EXPECT_NE(scales.find("hs-study-evaluate"), std::string::npos) << scales;
  FeatureSettings settings;
  settings.families = kIntensity | kHonv | kFastHistogram;
  const std::string surfaces = refusal(settings);
  EXPECT_NE(surfaces.find("a.forest: has the features 'honv,fpfh'"), std::string::npos) << surfaces;
  EXPECT_NE(surfaces.find("hs-study-train"), std::string::npos) << surfaces;
  EXPECT_EQ(surfaces.find('\n'), std::string::npos);
}

TEST(Extensions, NothingIsComputedOrTrainedWithoutThem) {
  FeatureSettings settings;
  settings.families = kCurvature;
  const WorkingFrame frame = make_working_frame(toy::room(5), 0.5F, settings);
  EXPECT_THROW(compute_features(frame, settings, 1), InputError);
  EXPECT_THROW(training::train_forest(toy::training_views(), make_profile("gall"), [](const auto&) {}), InputError);
}

}  // namespace
}  // namespace houghstream
