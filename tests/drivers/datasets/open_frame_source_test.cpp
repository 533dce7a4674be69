#include "drivers/datasets/open_frame_source.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const std::string kCameraText = ",64x48,60,61,31.5,23.5";

/// Writes frames desk_1_9 and desk_1_28, whose colour is `9` and `28`.
fs::path write_uw_folder(const std::string& name, const std::string& colour_end) {
  fs::path folder = fresh_folder(name);
  for (const int number : {28, 9}) {
    const std::string stem = "desk_1_" + std::to_string(number);
    write_png(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(number)), folder / (stem + colour_end));
    write_png(cv::Mat(48, 64, CV_16UC1, cv::Scalar(1500)), folder / (stem + "_depth.png"));
  }
  return folder;
}

TEST(FrameSource, BopGivesItsFramesAndEnds) {
  const fs::path folder = fresh_folder("source_bop");
  BopWriter writer(folder);
  writer.add(plain_frame(), {}, {});
  writer.add(plain_frame(), {}, {});
  writer.finish();
  const auto source = open_frame_source("bop:" + folder.string());
  EXPECT_EQ(source->rate_hz(), 30.0);
  EXPECT_EQ(source->next()->id.utime, dataset_utime(0));
  EXPECT_EQ(source->next()->id.utime, dataset_utime(1));
  EXPECT_FALSE(source->next().has_value());
  EXPECT_FALSE(source->next().has_value());
}

TEST(FrameSource, UwFramesComeInNaturalOrder) {
  for (const std::string end : {"_color.png", ".png"}) {
    const auto source = open_frame_source("uw:" + write_uw_folder("source_uw", end).string() + kCameraText);
    const auto first = source->next();
    ASSERT_TRUE(first.has_value());
    EXPECT_EQ(first->colour.at<cv::Vec3b>(0, 0)[0], 9);
    EXPECT_FLOAT_EQ(first->depth.at<float>(0, 0), 1.5F);
    EXPECT_EQ(first->camera.fx, 60.0);
    EXPECT_EQ(source->next()->colour.at<cv::Vec3b>(0, 0)[0], 28);
    EXPECT_FALSE(source->next().has_value());
  }
}

TEST(FrameSource, AFoldersNameMayHoldCommas) {
  const std::string folder = write_uw_folder("source_uw,of,1", ".png").string();
  EXPECT_EQ(open_frame_source("uw:" + folder + kCameraText)->next()->camera.fx, 60.0);
  EXPECT_EQ(error_of([&] { open_frame_source("uw:" + folder); }), "");
  const std::string missing = folder + ",2";
  EXPECT_NE(error_of([&] { open_frame_source("uw:/no/such" + missing); }).find("/no/such" + missing),
            std::string::npos);
}

TEST(FrameSource, WhatIsNotKnownIsRefusedWithAllThatTheCallerTakes) {
  EXPECT_EQ(error_of([] { open_frame_source("bogus", "oni:FILE, "); }),
            "source 'bogus', expected oni:FILE, bop:DIR, uw:DIR, tum:DIR or bag:FILE");
}

TEST(FrameSource, AFolderWithoutItsKindIsToldWithTheKindThatItHas) {
  const fs::path scene = fresh_folder("source_kinds") / "scene";
  BopWriter writer(scene);
  writer.add(plain_frame(), {}, {});
  writer.finish();
  const std::string images = write_uw_folder("source_kinds_uw", ".png").string();
  const fs::path sequence = fresh_folder("source_kinds_tum");
  write_text(sequence / "depth.txt", "");
  write_text(sequence / "take.oni", "");
  write_text(sequence / "notes.txt", "");
  const auto refusal = [](const std::string& place) { return error_of([&] { open_frame_source(place); }); };
  expect_says(refusal(scene.string()), {"did you mean bop:" + scene.string() + "?"});
  expect_says(refusal(images), {"did you mean uw:" + images + "?"});
  expect_says(refusal(sequence.string()), {"did you mean tum:" + sequence.string() + "?"});
  EXPECT_EQ(suggest_source((sequence / "take.oni").string()), "oni:" + (sequence / "take.oni").string());
  for (const fs::path& place : {sequence / "notes.txt", sequence / "take.bag", scene.parent_path()})
    EXPECT_EQ(suggest_source(place.string()), "") << place;
}

TEST(FrameSource, AFolderThatIsNoSceneIsToldByWhatIsThere) {
  const fs::path above = fresh_folder("source_above");
  expect_says(error_of([&] { open_frame_source("bop:" + (above / "none").string()); }),
              {(above / "none").string() + ": no such folder, expected a BOP scene folder"});
  write_text(above / "file", "");
  expect_says(error_of([&] { open_frame_source("bop:" + (above / "file").string()); }),
              {(above / "file").string() + ": is a file, expected a folder: a BOP scene folder"});
  expect_says(error_of([&] { open_frame_source("bop:" + above.string()); }),
              {above.string() + ": no scene_camera.json in it"});
  BopWriter writer(above / "scene");
  writer.add(plain_frame(), {}, {});
  writer.finish();
  expect_says(error_of([&] { open_frame_source("bop:" + above.string()); }),
              {"bop:" + (above / "scene").string() + " is one"});
}

TEST(FrameSource, BadSpecificationsAreRefused) {
  for (const std::string text : {"", "bop", "bop:", "nothing:x", "bop:/no/such/folder", "uw:/no/such/folder"}) {
    EXPECT_THROW(open_frame_source(text), InputError) << text;
  }
  const std::string folder = write_uw_folder("source_camera", ".png").string();
  EXPECT_THROW(open_frame_source("uw:" + folder + ",64x48"), InputError);
}

TEST(FrameSource, NothingIsWrittenIntoASource) {
  const fs::path folder = write_uw_folder("source_written", ".png");
  const fs::path file = folder / "desk_1_9.png";
  for (const std::string& source : {"uw:" + folder.string(), "uw:" + folder.string() + kCameraText}) {
    EXPECT_THROW(require_outside_source(folder, source), InputError) << source;
    EXPECT_THROW(require_outside_source(file, source), InputError) << source;
    EXPECT_THROW(require_outside_source(folder / "new.log", source), InputError) << source;
    EXPECT_NO_THROW(require_outside_source(folder.string() + ".log", source)) << source;
  }
  EXPECT_THROW(require_outside_source(file, "oni:" + file.string()), InputError);
  EXPECT_THROW(require_outside_source(file, file.string()), InputError);
  EXPECT_NO_THROW(require_outside_source(folder / "new.log", file.string()));
  EXPECT_NO_THROW(require_outside_source(folder / "new.log", "openni2"));
}

TEST(FrameSource, BadUwFoldersAreRefused) {
  EXPECT_THROW(open_frame_source("uw:" + fresh_folder("source_empty").string()), InputError);
  const fs::path no_depth = write_uw_folder("source_no_depth", "_color.png");
  fs::remove(no_depth / "desk_1_9_depth.png");
  EXPECT_THROW(open_frame_source("uw:" + no_depth.string()), InputError);
  const fs::path no_colour = write_uw_folder("source_no_colour", ".png");
  fs::remove(no_colour / "desk_1_9.png");
  EXPECT_THROW(open_frame_source("uw:" + no_colour.string()), InputError);
  const fs::path other_size = write_uw_folder("source_size", ".png");
  EXPECT_THROW(open_frame_source("uw:" + other_size.string())->next(), InputError) << "not 640x480";
  write_text(other_size / "desk_1_9.png", "no image");
  EXPECT_THROW(open_frame_source("uw:" + other_size.string() + kCameraText)->next(), InputError);
}

}  // namespace
}  // namespace houghstream
