#include "tools/capture/capture_options.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::capture {
namespace {

/// Parses the words as a command line.
SourceOptions parsed(const std::vector<std::string>& words) {
  CommandLine line("words", "name");
  SourceOptions options;
  add_source_options(line, options);
  EXPECT_EQ(line.parse(words), std::nullopt);
  return options;
}

std::string refusal(const std::vector<std::string>& words) {
  return error_of([&] { open_source(parsed(words), {}); });
}

TEST(CaptureOptions, AFolderIsOpenedByItsKind) {
  const std::filesystem::path folder = fresh_folder("capture_options");
  BopWriter writer(folder);
  writer.add(plain_frame(), {}, {});
  writer.finish();
  const auto source = open_source(parsed({"--source", "bop:" + folder.string()}), {});
  EXPECT_TRUE(source->next().has_value());
  EXPECT_FALSE(source->next().has_value());
}

TEST(CaptureOptions, WhatTheSourceCannotHeedIsRefused) {
  const std::string camera = "640x480,525,525,319.5,239.5";
  EXPECT_NE(refusal({"--source", "bop:/x", "--record", "x.oni"}).find("--record"), std::string::npos);
  EXPECT_NE(refusal({"--source", "oni:/x.oni", "--record", "y.oni"}).find("--record"), std::string::npos);
  EXPECT_NE(refusal({"--source", "tum:/x", "--camera", camera}).find("--camera"), std::string::npos);
  const std::vector<std::vector<std::string>> of_cameras = {{"--mode", "640x480@30"},
                                                            {"--no-auto-exposure"},
                                                            {"--no-auto-white-balance"},
                                                            {"--assume-registered"},
                                                            {"--record-jpeg"}};
  for (const char* source : {"bop:/x", "oni:/x.oni"}) {
    for (std::vector<std::string> words : of_cameras) {
      const std::string option = words.front();
      words.emplace_back("--source");
      words.emplace_back(source);
      EXPECT_EQ(refusal(words), option + " goes with --source openni2, not with " + source);
    }
  }
  EXPECT_NE(refusal({"--source", "openni2", "--record-jpeg"}).find("goes with --record"), std::string::npos);
}

TEST(CaptureOptions, WhatNamesNoSourceModeOrCameraIsRefused) {
  EXPECT_NE(refusal({"--source", "cinema:/x"}).find("cinema:/x"), std::string::npos);
  EXPECT_NE(refusal({"--source", "cinema:/x"}).find("expected openni2, openni2:CAMERA, oni:FILE"), std::string::npos);
  EXPECT_NE(refusal({"--source", "bag:/no/such.bag"}).find("/no/such.bag"), std::string::npos);
  EXPECT_NE(refusal({"--source", "klg:/x"}).find("hs-log import"), std::string::npos);
  EXPECT_NE(refusal({"--source", "oni:"}).find("oni:"), std::string::npos);
  EXPECT_NE(refusal({"--source", "openni2", "--mode", "large"}).find("large"), std::string::npos);
  EXPECT_NE(refusal({"--source", "oni:/x.oni", "--camera", "640x480"}), "");
}

}  // namespace
}  // namespace houghstream::capture
