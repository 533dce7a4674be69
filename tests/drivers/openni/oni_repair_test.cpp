#include "drivers/openni/oni_repair.hpp"

#include <gtest/gtest.h>

#include "drivers/openni/oni_times.hpp"
#include "tests/drivers/openni/virtual_camera.hpp"

namespace houghstream::openni {
namespace {

/// Returns a recording of the virtual camera's, without the room that OpenNI2's recorder leaves behind its end.
std::string recorded_bytes(const VirtualCamera& camera) {
  CameraOptions options;
  options.mode = {320, 240, 30};
  options.record = (camera.folder() / "recorded.oni").string();
  {
    const auto device = OpenniDevice::open_camera("houghstream-virtual://1", options);
    for (int i = 0; i < 30; ++i) EXPECT_TRUE(device->wait(std::chrono::seconds(5)).has_value());
  }
  repair_oni(options.record);
  return read_text(options.record);
}

/// Counts the images as OpenNI2 plays them.
std::size_t images_played(const std::filesystem::path& file) {
  const auto device = OpenniDevice::open_file(file.string());
  std::size_t images = 0;
  while (!device->ended()) images += device->wait(std::chrono::seconds(5)).has_value() ? 1U : 0U;
  return images;
}

TEST(OniRepair, WhatWasCutAnywhereIsPlayedAsFarAsItsImagesAreWhole) {
  const VirtualCamera camera("repair", "size 320x240\n");
  const std::string whole = recorded_bytes(camera);
  const std::filesystem::path file = camera.folder() / "cut.oni";
  write_text(file, whole);
  const std::size_t all = check_oni(file);
  EXPECT_EQ(repair_oni(file), all) << "of a whole one nothing is lost";
  EXPECT_EQ(images_played(file), all);
  std::size_t before = 0;
  for (const double part : {0.3, 0.7, 0.9, 0.999}) {
    write_text(file, whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    EXPECT_THROW(check_oni(file), InputError);
    const std::size_t images = repair_oni(file);
    EXPECT_EQ(check_oni(file), images);
    EXPECT_EQ(images_played(file), images);
    EXPECT_GE(images, before);
    before = images;
  }
  EXPECT_GE(before + 2, all);
}

TEST(OniRepair, ACopyIsRepairedAndItsSourceStays) {
  const VirtualCamera camera("repair_copy", "size 320x240\n");
  const std::string whole = recorded_bytes(camera);
  const std::string cut = whole.substr(0, whole.size() / 2);
  const std::filesystem::path file = camera.folder() / "cut.oni";
  write_text(file, cut);
  const std::filesystem::path copy = camera.folder() / "copy.oni";
  const std::size_t images = copy_repaired_oni(file, copy);
  EXPECT_EQ(check_oni(copy), images);
  EXPECT_EQ(read_text(file), cut);
  EXPECT_THROW(copy_repaired_oni(file, file), InputError);
  write_text(file, whole.substr(0, 100));
  EXPECT_THROW(copy_repaired_oni(file, camera.folder() / "none.oni"), InputError);
  EXPECT_FALSE(std::filesystem::exists(camera.folder() / "none.oni"));
}

TEST(OniRepair, ARecordingWithoutAnImageIsLeftAsItWas) {
  const VirtualCamera camera("repair_none", "size 320x240\n");
  const std::string whole = recorded_bytes(camera);
  const std::filesystem::path file = camera.folder() / "cut.oni";
  for (const std::string& bytes :
       {std::string(), std::string("no recording"), whole.substr(0, 24), whole.substr(0, 500)}) {
    write_text(file, bytes);
    EXPECT_THROW(repair_oni(file), InputError) << bytes.size();
    EXPECT_EQ(read_text(file), bytes);
  }
}

}  // namespace
}  // namespace houghstream::openni
