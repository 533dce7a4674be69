#include "drivers/datasets/dataset_sources.hpp"

#include <gtest/gtest.h>

#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const Camera kCamera{64, 48, 60.0, 60.0, 31.5, 23.5};

void write_images(const fs::path& folder, int count) {
  fs::create_directories(folder / "rgb");
  fs::create_directories(folder / "depth");
  for (int i = 0; i < count; ++i) {
    write_png(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(i)), folder / "rgb" / (std::to_string(i) + ".png"));
    write_png(cv::Mat(48, 64, CV_16UC1, cv::Scalar(5000 + 5 * i)), folder / "depth" / (std::to_string(i) + ".png"));
  }
}

TEST(TumSource, PairsNearestInTime) {
  const fs::path folder = fresh_folder("tum_pairs");
  write_images(folder, 4);
  write_text(folder / "rgb.txt",
             "# color images\n1305031102.175304 rgb/0.png\n1305031102.211214 rgb/1.png\n1305031102.243211 rgb/2.png\n"
             "1305031109.0 rgb/3.png\n");
  // The second depth image is nearer to the third colour image than to the second; the third has no partner left.
  write_text(folder / "depth.txt",
             "# depth maps\n1305031102.160407 depth/0.png\n1305031102.240000 depth/1.png\n"
             "1305031102.262886 depth/2.png\n1305031105.0 depth/3.png\n");
  const auto source = open_tum_source(folder, kCamera);
  const auto first = source->next();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->id.utime, 1'305'031'102'160'407);
  EXPECT_EQ(first->colour.at<cv::Vec3b>(0, 0)[0], 0);
  EXPECT_FLOAT_EQ(first->depth.at<float>(0, 0), 1.0F);
  const auto second = source->next();
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->id.utime, 1'305'031'102'240'000);
  EXPECT_EQ(second->colour.at<cv::Vec3b>(0, 0)[0], 2);
  EXPECT_FLOAT_EQ(second->depth.at<float>(0, 0), 1.001F);
  EXPECT_FALSE(source->next().has_value());
}

TEST(TumSource, BadFoldersAreRefused) {
  const fs::path folder = fresh_folder("tum_bad");
  EXPECT_THROW(open_tum_source(folder, kCamera), InputError);
  write_images(folder, 1);
  write_text(folder / "rgb.txt", "1.0 rgb/0.png\n");
  write_text(folder / "depth.txt", "# nothing\n");
  EXPECT_THROW(open_tum_source(folder, kCamera), InputError);
  write_text(folder / "depth.txt", "one depth/0.png\n");
  EXPECT_THROW(open_tum_source(folder, kCamera), InputError);
  write_text(folder / "depth.txt", "2.0 depth/0.png\n");
  EXPECT_THROW(open_tum_source(folder, kCamera), InputError) << "a second apart";
  write_text(folder / "depth.txt", "1.01 depth/missing.png\n");
  EXPECT_THROW(open_tum_source(folder, kCamera)->next(), InputError);
  std::string all_at_once;
  for (int i = 0; i < 65; ++i) all_at_once += "1.0 rgb/0.png\n";
  write_text(folder / "rgb.txt", all_at_once);
  EXPECT_NE(error_of([&] { open_tum_source(folder, kCamera); }).find("more than 64 colour images"), std::string::npos);
}

}  // namespace
}  // namespace houghstream
