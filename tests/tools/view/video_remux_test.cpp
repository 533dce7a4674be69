#include "tools/view/video_remux.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::view {
namespace {

TEST(VideoRemux, WhatIsNoVideoIsRefusedAndNamed) {
  const std::filesystem::path folder = fresh_folder("video_remux");
  const std::filesystem::path text = folder / "text.mkv";
  write_text(text, "no video, but some words that are long enough to be looked at");
  for (const std::filesystem::path& file : {text, folder / "missing.mkv", folder}) {
    const std::string error = error_of([&] { remux_video(file, folder / "out.mp4", 10.0); });
    EXPECT_EQ(error.substr(0, file.string().size()), file.string()) << error;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out.mp4"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace houghstream::view
