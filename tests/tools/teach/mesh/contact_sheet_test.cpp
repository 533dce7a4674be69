#include "tools/teach/mesh/contact_sheet.hpp"

#include <gtest/gtest.h>

#include "drivers/files/image_file.hpp"
#include "tests/test_files.hpp"

namespace houghstream::teach {
namespace {

TEST(ContactSheet, APictureOfAnotherWidthIsNamed) {
  const std::filesystem::path folder = fresh_folder("contact_sheet");
  write_png(cv::Mat(10, 30, CV_8UC3, cv::Scalar(1, 2, 3)), folder / "a.png");
  write_png(cv::Mat(10, 40, CV_8UC3, cv::Scalar(1, 2, 3)), folder / "b.png");
  write_contact_sheet({folder / "a.png", folder / "a.png"}, folder / "sheet.png");
  EXPECT_EQ(read_colour_image(folder / "sheet.png").size(), cv::Size(30, 20));
  const std::string words = error_of([&] {
    write_contact_sheet({folder / "a.png", folder / "b.png"}, folder / "sheet.png");
  });
  EXPECT_NE(words.find("b.png: 40 pixels wide, expected 30"), std::string::npos) << words;
}

}  // namespace
}  // namespace houghstream::teach
