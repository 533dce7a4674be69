#include "drivers/files/frame_folder.hpp"

#include <gtest/gtest.h>

#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

void plant(const fs::path& folder, const std::string& colour, const std::string& depth) {
  fs::create_directories(folder);
  const RgbdFrame frame = plain_frame();
  if (!colour.empty()) write_png(frame.colour, folder / colour);
  if (!depth.empty()) write_png(depth_to_millimetres(frame.depth), folder / depth);
}

TEST(FrameFolder, PairsAreFoundUnderAnyOfTheirNamesAndOrderedByNumber) {
  const fs::path folder = fresh_folder("frame_folder_names");
  plant(folder, "a_10.png", "a_10_depth.png");
  plant(folder, "a_9_color.png", "a_9_depth.png");
  plant(folder, "a_2-color.png", "a_2-depth.png");
  const std::vector<FrameFiles> pairs = list_frame_pairs(folder);
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_EQ(pairs[0].name, "a_2");
  EXPECT_EQ(pairs[1].colour.filename(), "a_9_color.png");
  EXPECT_EQ(pairs[2].depth.filename(), "a_10_depth.png");
  const RgbdFrame frame = read_frame_pair(pairs[2], plain_frame().camera, 77);
  EXPECT_EQ(frame.id.utime, 77);
  EXPECT_EQ(cv::norm(frame.colour, plain_frame().colour, cv::NORM_INF), 0.0);
  Camera other = plain_frame().camera;
  other.width = 32;
  EXPECT_THROW(read_frame_pair(pairs[2], other, 0), InputError);
}

TEST(FrameFolder, AnImageOrDepthAloneIsAnError) {
  const fs::path no_depth = fresh_folder("frame_folder_no_depth");
  plant(no_depth, "a_color.png", "a_depth.png");
  plant(no_depth, "b_color.png", "");
  EXPECT_THROW(list_frame_pairs(no_depth), InputError);
  const fs::path no_colour = fresh_folder("frame_folder_no_colour");
  plant(no_colour, "", "a_depth.png");
  EXPECT_THROW(list_frame_pairs(no_colour), InputError);
  EXPECT_THROW(list_frame_pairs(fresh_folder("frame_folder_empty")), InputError);
  EXPECT_THROW(list_frame_pairs("/no/such/folder"), InputError);
}

TEST(FrameFolder, FoldersWithImagesAreFoundAtAnyDepth) {
  const fs::path folder = fresh_folder("frame_folder_deep");
  EXPECT_THROW(list_frame_folders(folder), InputError);
  plant(folder / "room_10", "a.png", "a_depth.png");
  plant(folder / "house" / "room_2", "a.png", "a_depth.png");
  fs::create_directories(folder / "empty");
  EXPECT_EQ(list_frame_folders(folder), (std::vector<fs::path>{folder / "house" / "room_2", folder / "room_10"}));
  EXPECT_THROW(list_frame_folders("/no/such/folder"), InputError);
}

}  // namespace
}  // namespace houghstream
