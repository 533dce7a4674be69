#include "tools/teach/show/turntable_videos.hpp"

#include <gtest/gtest.h>

#include "tests/test_files.hpp"
#include "tools/teach/show/show_jobs.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;

/// CATEGORY/INSTANCE with a mask, and nothing that it belongs to.
fs::path folder_of_videos(const std::string& name) {
  fs::path folder = fresh_folder(name) / "fruit" / "apple_1";
  fs::create_directories(folder);
  write_text(folder / "apple_1_1_1_maskcrop.png", "");
  return folder;
}

std::string refusal_of_videos(const std::string& source, const std::string& second = "") {
  ShowOptions options;
  options.source = source;
  options.second = second;
  options.name = "apple";
  options.teach = false;
  return error_of([&] { show_sources(options, nullptr); });
}

TEST(TurntableVideos, TheInstanceIsThatOfTheFolderHoweverItIsNamed) {
  const fs::path folder = folder_of_videos("videos_named");
  const std::string expected = "no views, expected apple_1_V_N_crop.png";
  EXPECT_TRUE(is_turntable_videos("uw:" + folder.string()));
  EXPECT_NE(refusal_of_videos("uw:" + folder.string()).find(expected), std::string::npos);
  EXPECT_NE(refusal_of_videos("uw:" + folder.string() + "/").find(expected), std::string::npos);
  const fs::path before = fs::current_path();
  fs::current_path(folder.parent_path());
  const std::string from_beside = refusal_of_videos("uw:apple_1");
  fs::current_path(before);
  EXPECT_NE(from_beside.find(expected), std::string::npos) << from_beside;
}

TEST(TurntableVideos, TheyHaveNoSecondTake) {
  const std::string videos = "uw:" + folder_of_videos("videos_second").string();
  EXPECT_NE(refusal_of_videos(videos, "log:take.lcmlog").find(videos + " holds turntable videos"), std::string::npos);
  EXPECT_NE(refusal_of_videos("log:take.lcmlog", videos).find(videos + " holds turntable videos"), std::string::npos);
}

}  // namespace
}  // namespace houghstream::teach
