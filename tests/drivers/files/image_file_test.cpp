#include "drivers/files/image_file.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

TEST(ImageFile, ImagesComeBackAsTheyWere) {
  const fs::path folder = fresh_folder("image_file");
  cv::Mat colour(20, 30, CV_8UC3);
  cv::randu(colour, 0, 256);
  cv::Mat depth(20, 30, CV_16UC1);
  cv::randu(depth, 0, 65536);
  write_png(colour, folder / "colour.png");
  write_png(depth, folder / "depth.png");
  EXPECT_EQ(cv::norm(read_colour_image(folder / "colour.png"), colour, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(read_depth_image(folder / "depth.png"), depth, cv::NORM_INF), 0.0);
}

TEST(ImageFile, AGreyImageIsReadAsColourButNotAsDepth) {
  const fs::path file = fresh_folder("image_file_grey") / "grey.png";
  write_png(cv::Mat(4, 6, CV_8UC1, cv::Scalar(70)), file);
  EXPECT_EQ(read_colour_image(file).at<cv::Vec3b>(1, 1), cv::Vec3b(70, 70, 70));
  EXPECT_THROW(read_depth_image(file), InputError);
}

TEST(ImageFile, AMaskIsAllOrNothing) {
  const fs::path file = fresh_folder("image_file_mask") / "mask.png";
  write_png((cv::Mat_<std::uint8_t>(1, 4) << 0, 1, 128, 255), file);
  const cv::Mat mask = read_mask_image(file);
  ASSERT_EQ(mask.type(), CV_8UC1);
  const cv::Mat expected = (cv::Mat_<std::uint8_t>(1, 4) << 0, 255, 255, 255);
  EXPECT_EQ(cv::norm(mask, expected, cv::NORM_INF), 0.0);
}

TEST(ImageFile, WhatIsMissingNoImageOrCannotBeWrittenIsAnError) {
  const fs::path folder = fresh_folder("image_file_bad");
  write_text(folder / "text.png", "no image");
  for (const fs::path& file : {folder / "none.png", folder / "text.png", folder}) {
    EXPECT_THROW(read_colour_image(file), InputError) << file;
    EXPECT_THROW(read_depth_image(file), InputError) << file;
    EXPECT_THROW(read_mask_image(file), InputError) << file;
  }
  const cv::Mat image(4, 6, CV_8UC3, cv::Scalar(1, 2, 3));
  EXPECT_THROW(write_png(image, folder / "no" / "such" / "folder.png"), InputError);
  EXPECT_THROW(write_png(cv::Mat(4, 6, CV_8UC(7), cv::Scalar(0)), folder / "seven.png"), InputError);
}

// A decoder would fill up the missing rows silently.
TEST(ImageFile, ACutJpegIsRefused) {
  const fs::path folder = fresh_folder("image_file_cut");
  cv::Mat colour(40, 30, CV_8UC3);
  cv::randu(colour, 0, 256);
  write_image(colour, folder / "whole.jpg");
  EXPECT_EQ(read_colour_image(folder / "whole.jpg").size(), colour.size());
  const std::string whole = read_text(folder / "whole.jpg");
  for (const std::size_t missing : {1U, 2U, 100U, 1000U}) {
    write_text(folder / "cut.jpg", whole.substr(0, whole.size() - missing));
    EXPECT_THROW(read_colour_image(folder / "cut.jpg"), InputError) << missing << " of " << whole.size();
  }
  write_text(folder / "more.jpg", whole + "what a camera's maker adds");
  EXPECT_EQ(read_colour_image(folder / "more.jpg").size(), colour.size());
}

TEST(ImageFile, TheFormatIsKnownByTheEndingBeforeThereIsAnImage) {
  for (const char* name : {"a.png", "A.JPG", "b.c/d.jpeg"}) EXPECT_NO_THROW(require_image_format(name)) << name;
  for (const char* name : {"", "a", "a.nosuch", "a.png/b"})
    EXPECT_THROW(require_image_format(name), InputError) << name;
}

}  // namespace
}  // namespace houghstream
