#include "tools/evaluate/import/drawn_boxes.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

const std::string kBoxes = R"({"image_size": [64, 48], "camera": {"fx": 60, "fy": 61, "cx": 31.5, "cy": 23.5},
 "frames": [{"frame": "b", "objects": [{"object": "pack", "bbox_xyxy": [10, 5, 30.4, 25]}]},
            {"frame": "a", "objects": []}]})";

TEST(DrawnBoxes, AreReadInTheFilesOrder) {
  const std::filesystem::path file = fresh_folder("drawn_boxes") / "boxes.json";
  write_text(file, kBoxes);
  const DrawnBoxes drawn = read_drawn_boxes(file);
  EXPECT_EQ(drawn.camera.width, 64);
  EXPECT_EQ(drawn.camera.fy, 61.0);
  ASSERT_EQ(drawn.frames.size(), 2U);
  EXPECT_EQ(drawn.frames[0].name, "b");
  ASSERT_EQ(drawn.frames[0].boxes.size(), 1U);
  EXPECT_EQ(drawn.frames[0].boxes[0].object, "pack");
  EXPECT_EQ(drawn.frames[0].boxes[0].box_px, cv::Rect(10, 5, 20, 20));
  EXPECT_TRUE(drawn.frames[1].boxes.empty());
}

TEST(DrawnBoxes, BadFilesAreRefused) {
  const std::filesystem::path file = fresh_folder("drawn_boxes_bad") / "boxes.json";
  EXPECT_THROW(read_drawn_boxes(file), InputError) << "no such file";
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{{"[10, 5, 30.4, 25]", "[10, 5, 30]"},
                                                                                 {"30.4", "65"},
                                                                                 {"30.4", "9"},
                                                                                 {"\"pack\"", "7"},
                                                                                 {"\"frames\"", "\"pictures\""}}) {
    write_text(file, kBoxes);
    replace_in_file(file, from, to);
    EXPECT_THROW(read_drawn_boxes(file), InputError) << from << " -> " << to;
  }
}

}  // namespace
}  // namespace houghstream
