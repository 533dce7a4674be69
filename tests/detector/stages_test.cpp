#include "detector/stages.hpp"

#include <gtest/gtest.h>

#include "detector/baseline/gall_profile.hpp"
#include "detector/features/features.hpp"
#include "detector/training/forest_trainer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/detector/toy_data.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

std::string refusal(const FeatureSettings& settings) {
  return error_of([&] { require_searchable(settings, "a.forest"); });
}

TEST(Searchable, TheProductsProfilesAre) {
  for (const std::string& name : profile_names()) EXPECT_EQ(refusal(make_profile(name).features), "") << name;
}

TEST(Searchable, WhatIsNotIsNamedWithWhoNeedsItAndWhoHasIt) {
  const std::string scales = refusal(baseline::make_profile("gall").features);
  EXPECT_NE(scales.find("a.forest: searches several sizes of the image"), std::string::npos) << scales;
  EXPECT_NE(scales.find("hs-study evaluate"), std::string::npos) << scales;
  FeatureSettings settings;
  settings.families = kIntensity | kHonv | kFastHistogram;
  const std::string surfaces = refusal(settings);
  EXPECT_NE(surfaces.find("a.forest: has the features 'honv,fpfh'"), std::string::npos) << surfaces;
  EXPECT_NE(surfaces.find("hs-study train"), std::string::npos) << surfaces;
  EXPECT_EQ(surfaces.find('\n'), std::string::npos);
}

TEST(Searchable, NothingElseIsComputedOrTaughtByTheProduct) {
  FeatureSettings settings;
  settings.families = kCurvature;
  const WorkingFrame frame = make_working_frame(toy::background(5), 0.5F, settings);
  EXPECT_THROW(compute_features(frame, settings, 1), InputError);
  const Profile gall = baseline::make_profile("gall");
  EXPECT_THROW(training::train_forest(toy::training_views(), gall, [](const auto&) {}), InputError);
}

}  // namespace
}  // namespace houghstream
