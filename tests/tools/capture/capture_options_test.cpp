#include "tools/capture/capture_options.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/drivers/test_files.hpp"

namespace houghstream::capture {
namespace {

/// What the command line makes of the words.
SourceOptions parsed(const std::vector<std::string>& words) {
  CommandLine line("words", "name");
  SourceOptions options;
  add_source_options(line, options);
  EXPECT_EQ(line.parse(words), std::nullopt);
  return options;
}

std::string refusal(const std::vector<std::string>& words) {
  try {
    open_source(parsed(words), {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
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
}

TEST(CaptureOptions, WhatNamesNoSourceModeOrCameraIsRefused) {
  EXPECT_NE(refusal({"--source", "cinema:/x"}).find("cinema:/x"), std::string::npos);
  EXPECT_NE(refusal({"--source", "oni:"}).find("oni:"), std::string::npos);
  EXPECT_NE(refusal({"--source", "openni2", "--mode", "large"}).find("large"), std::string::npos);
  EXPECT_NE(refusal({"--source", "oni:/x.oni", "--camera", "640x480"}), "");
}

}  // namespace
}  // namespace houghstream::capture
