#include "tools/finder/search_options.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "detector/forest/forest.hpp"
#include "tests/test_files.hpp"
#include "tools/finder/search_arguments.hpp"

namespace houghstream {
namespace {

Forest forest_of(const std::string& profile) {
  Forest forest;
  forest.profile = profile;
  forest.classes.resize(4);  // as the profiles have in mind
  return forest;
}

SearchOptions parsed(const std::vector<std::string>& words) {
  SearchOptions options;
  CommandLine line("words", "name");
  add_search_options(line, options);
  EXPECT_EQ(line.parse(words), std::nullopt);
  return options;
}

TEST(SearchOptions, WithoutOptionsAForestIsSearchedAsItsProfileSays) {
  for (const std::string& name : profile_names()) {
    const DetectionSettings expected = detection_settings(name);
    const DetectionSettings settings = parsed({}).settings_for(forest_of(name));
    EXPECT_EQ(settings.spacing.stride, expected.spacing.stride) << name;
    EXPECT_EQ(settings.spacing.metres, expected.spacing.metres) << name;
    EXPECT_EQ(settings.evidence.threshold, expected.evidence.threshold) << name;
    EXPECT_EQ(settings.voting.min_mass_fraction, expected.voting.min_mass_fraction) << name;
    EXPECT_EQ(settings.leaves.min_class_fraction, expected.leaves.min_class_fraction) << name;
    EXPECT_EQ(settings.voting.vote_sigma, expected.voting.vote_sigma) << name;
  }
}

TEST(SearchOptions, WhatIsAskedForReplacesTheProfilesOwn) {
  SearchOptions options = parsed({"--threads", "3", "--stride", "4", "--threshold", "0.25"});
  options.min_mass_fraction = 0.07F;
  const DetectionSettings settings = options.settings_for(forest_of("paper"));
  EXPECT_EQ(settings.threads, 3);
  EXPECT_EQ(settings.spacing.stride, 4);
  EXPECT_EQ(settings.spacing.metres, 0.0F);
  EXPECT_EQ(settings.evidence.threshold, 0.25F);
  EXPECT_EQ(settings.voting.min_mass_fraction, 0.07F);
}

TEST(SearchOptions, ThresholdsOfClassesGoBeforeTheCommonOne) {
  SearchOptions options;
  options.class_thresholds = {{"mug", 0.8F}};
  const EvidenceSettings evidence = options.settings_for(forest_of("realtime")).evidence;
  EXPECT_EQ(evidence.threshold_of("mug"), 0.8F);
  EXPECT_EQ(evidence.threshold_of("bowl"), EvidenceSettings{}.threshold);
  DetectionSettings settings;
  settings.evidence.class_thresholds = {{"mug", 1.5F}};
  EXPECT_NE(error_of([&] { check_settings(settings, "settings"); }).find("threshold of 'mug' 1.5, expected 0 to 1"),
            std::string::npos);
}

TEST(SearchOptions, APrecisionStandsInThePlaceOfAThreshold) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--precision", "1"},
                                                {"--precision", "-0.1"},
                                                {"--precision", "nan"},
                                                {"--precision", "0.9", "--threshold", "0.5"}}) {
    SearchOptions options;
    std::optional<double> precision;
    CommandLine line("words", "name");
    add_search_options(line, options);
    add_precision_option(line, precision, "words").excludes(line.get_option("--threshold"));
    testing::internal::CaptureStderr();
    EXPECT_EQ(line.parse(words).value_or(0), 2) << words[1];
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("--precision"), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  }
}

TEST(SearchOptions, AbsurdValuesAreRefused) {
  const std::vector<std::vector<std::string>> absurd = {
      {"--stride", "0"},    {"--stride", "100"},   {"--threads", "0"},    {"--threshold", "high"},
      {"--threshold", "5"}, {"--threshold", "-1"}, {"--threshold", "nan"}};
  for (const std::vector<std::string>& words : absurd) {
    SearchOptions options;
    CommandLine line("words", "name");
    add_search_options(line, options);
    EXPECT_NE(line.parse(words).value_or(0), 0) << words[0] << ' ' << words[1];
  }
}

}  // namespace
}  // namespace houghstream
