#include "tools/log/klg_file.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/log/recordings.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

fs::path write_klg(const std::string& name, std::int32_t stated_frames) {
  fs::path file = fresh_folder(name) / "a.klg";
  KlgWriter writer(stated_frames);
  writer.add(numbered_frame(0), true);
  writer.add(numbered_frame(1), false);
  writer.save(file);
  return file;
}

TEST(KlgFile, CompressedAndRawFramesAreRead) {
  KlgFile klg(write_klg("klg_good", 2), 64, 48);
  for (int i = 0; i < 2; ++i) {
    const std::optional<images_t> message = klg.next();
    ASSERT_TRUE(message.has_value());
    EXPECT_EQ(message->utime, numbered_frame(i).id.utime);
    const FrameImages images = images_from_message(*message);
    const cv::Mat depth_mm = depth_to_millimetres(numbered_frame(i).depth);
    EXPECT_EQ(cv::norm(images.depth_mm, depth_mm, cv::NORM_INF), 0.0);
    if (i == 1) {
      EXPECT_EQ(cv::norm(images.colour, numbered_frame(1).colour, cv::NORM_INF), 0.0);
    }
  }
  EXPECT_FALSE(klg.next().has_value());
}

TEST(KlgFile, ACutFileSaysWhere) {
  const fs::path file = write_klg("klg_cut", 2);
  fs::resize_file(file, fs::file_size(file) - 10);
  KlgFile klg(file, 64, 48);
  EXPECT_TRUE(klg.next().has_value());
  EXPECT_THROW(klg.next(), InputError);
  EXPECT_EQ(klg.bytes_left(), 16U + 64 * 48 * 5 - 10);
  KlgFile more_promised(write_klg("klg_promise", 3), 64, 48);
  EXPECT_TRUE(more_promised.next().has_value());
  EXPECT_TRUE(more_promised.next().has_value());
  EXPECT_THROW(more_promised.next(), InputError);
}

// The number is written last: it is 0 where the recorder was killed, and may be a smaller one where a bit has flipped.
TEST(KlgFile, FramesBehindTheStatedNumberAreTold) {
  KlgFile klg(write_klg("klg_fewer", 1), 64, 48);
  EXPECT_TRUE(klg.next().has_value());
  EXPECT_NE(error_of([&] { klg.next(); }).find("states 1 frames, but "), std::string::npos);
  EXPECT_EQ(klg.bytes_left(), 16U + 64 * 48 * 5);
  KlgFile none(write_klg("klg_none_stated", 0), 64, 48);
  EXPECT_THROW(none.next(), InputError);
}

TEST(KlgFile, WhatIsNoneIsRefused) {
  const fs::path folder = fresh_folder("klg_none");
  EXPECT_THROW(KlgFile(folder / "missing.klg", 64, 48), InputError);
  write_text(folder / "empty.klg", "");
  EXPECT_THROW(KlgFile(folder / "empty.klg", 64, 48), InputError);
  EXPECT_THROW(KlgFile(write_klg("klg_negative", -1), 64, 48), InputError);
  EXPECT_THROW(KlgFile(write_klg("klg_size", 2), 0, 48), InputError);
}

}  // namespace
}  // namespace houghstream::log_tools
