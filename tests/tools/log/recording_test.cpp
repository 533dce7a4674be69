#include "tools/log/recording.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/log/recordings.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

/// Returns the pixel by which numbered frames differ, frame by frame.
std::vector<int> numbers_in(const RecordingSettings& settings, LossReport& losses) {
  std::vector<int> numbers;
  const NextFrame next = open_recording(settings, losses);
  while (const std::optional<RecordedFrame> frame = next()) {
    numbers.push_back(images_from_message(frame->message).colour.at<cv::Vec3b>(7, 9)[0]);
  }
  EXPECT_FALSE(next().has_value()) << "the end stays the end";
  return numbers;
}

TEST(Recording, TheFirstChannelWithFramesIsReadUnlessOneIsNamed) {
  const fs::path folder = fresh_folder("recording_channels");
  TestLog log(folder / "log");
  log.add_bytes("OTHER", {1, 2, 3});
  for (int i = 0; i < 4; ++i) log.add(i % 2 == 0 ? "LEFT" : "RIGHT", foreign_images(numbered_frame(i)));
  log.close();
  LossReport losses;
  RecordingSettings settings;
  settings.source = (folder / "log").string();
  EXPECT_EQ(numbers_in(settings, losses), (std::vector<int>{0, 2}));
  settings.channel = "RIGHT";
  EXPECT_EQ(numbers_in(settings, losses), (std::vector<int>{1, 3}));
  EXPECT_EQ(losses.line(), "");
  settings.channel = "NOTHING";
  EXPECT_THROW(numbers_in(settings, losses), InputError);
}

TEST(Recording, WhatIsNotThereIsAnErrorThatNamesIt) {
  LossReport losses;
  for (const std::string source :
       {"/no/such.log", "/no/such.klg", "/no/such.oni", "oni:/no/such", "bop:/no/such", "bag:/no/such"}) {
    RecordingSettings settings;
    SCOPED_TRACE(source);
    settings.source = source;
    expect_says(error_of([&] { open_recording(settings, losses)(); }), {"/no/such"});
  }
}

TEST(Recording, OtherMakersRecordingsAreNamed) {
  const fs::path folder = fresh_folder("recording_others");
  const std::vector<std::pair<std::string, std::string>> kinds = {
      {"SQLite format 3", "rosbag2"}, {"\x89MCAP0\r\n", "an MCAP file"}, {"\x1A\x45\xDF\xA3", "Azure Kinect"}};
  for (const auto& [begin, name] : kinds) {
    RecordingSettings settings;
    settings.source = (folder / "taken.bag").string();
    write_text(settings.source, begin + std::string(100, 'x'));
    LossReport losses;
    try {
      open_recording(settings, losses);
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(settings.source + ": ", 0), 0U) << error.what();
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

TEST(Recording, FramesKeepTheirOwnCameraAndTimeAndAreCounted) {
  const fs::path folder = fresh_folder("recording_camera");
  TestLog log(folder / "log");
  WireFormat raw;
  raw.jpeg = false;
  log.add("FRAMES", to_message(numbered_frame(0), raw, 70));
  log.add("FRAMES", foreign_images(numbered_frame(1)));
  log.close();
  RecordingSettings settings;
  settings.source = (folder / "log").string();
  settings.camera = Camera{64, 48, 99.0, 99.0, 31.0, 23.0};
  LossReport losses;
  const NextFrame next = open_recording(settings, losses);
  const std::optional<RecordedFrame> own = next();
  const std::optional<RecordedFrame> given = next();
  ASSERT_TRUE(own && given);
  EXPECT_EQ(read_camera_metadata(own->message), numbered_frame(0).camera);
  EXPECT_EQ(read_sequence_number(own->message), 70);
  EXPECT_EQ(read_camera_metadata(given->message), settings.camera);
  EXPECT_EQ(read_sequence_number(given->message), 1);
  EXPECT_EQ(given->timestamp, 1'500'000'000'033'000);
}

TEST(Recording, AKlgFileIsKnownByItsNameOrByItsKindAndEndsWhereItIsCut) {
  const fs::path folder = fresh_folder("recording_klg");
  KlgWriter writer(3);
  for (int i = 0; i < 3; ++i) writer.add(numbered_frame(i), false);
  writer.save(folder / "a.klg");
  fs::copy_file(folder / "a.klg", folder / "plain");
  RecordingSettings settings;
  settings.camera = make_test_frame(0).camera;
  for (const std::string& source : {(folder / "a.klg").string(), "klg:" + (folder / "plain").string()}) {
    settings.source = source;
    LossReport losses;
    EXPECT_EQ(numbers_in(settings, losses), (std::vector<int>{0, 1, 2})) << source;
    EXPECT_EQ(losses.line(), "") << source;
  }
  fs::resize_file(folder / "a.klg", fs::file_size(folder / "a.klg") - 1);
  settings.source = (folder / "a.klg").string();
  LossReport losses;
  EXPECT_EQ(numbers_in(settings, losses), (std::vector<int>{0, 1}));
  EXPECT_EQ(losses.damaged_places(), 1);
}

TEST(Recording, WhatCannotBeOpenedOrMakesNoSenseIsRefused) {
  const fs::path folder = fresh_folder("recording_refused");
  LossReport losses;
  RecordingSettings settings;
  for (const std::string source : {"nothing", "nothing.klg", "klg:nothing", "bop:nothing"}) {
    settings.source = source;
    EXPECT_THROW(numbers_in(settings, losses), InputError) << source;
  }
  write_text(folder / "depth.txt", "");
  settings.source = folder.string();
  EXPECT_NE(error_of([&] { open_recording(settings, losses); }).find("did you mean tum:" + folder.string() + "?"),
            std::string::npos);
  settings.source = log_of(folder, 1, "FRAMES", foreign_images);
  settings.camera = Camera{64, 48, -1.0, 99.0, 31.0, 23.0};
  EXPECT_THROW(open_recording(settings, losses), InputError);
}

namespace fs = std::filesystem;

constexpr int kImported = 3;
const Camera kImportedCamera = make_test_frame(0).camera;

TEST(ImportLog, KeepsTimesAndAddsWhatIsMissing) {
  const fs::path folder = fresh_folder("import_keeps");
  LossReport losses;
  RecordingSettings settings;
  settings.source = log_of(folder, kImported, "OPENNI_FRAME", foreign_images);
  settings.camera = kImportedCamera;
  import_log(settings, "MINE", folder / "out", losses);
  LogReader log(folder / "out");
  for (int i = 0; i < kImported; ++i) {
    const auto event = log.next();
    ASSERT_TRUE(event.has_value());
    EXPECT_EQ(event->channel, "MINE");
    EXPECT_EQ(event->timestamp, 1'500'000'000'000'000 + 33'000 * 2 * i);
    const auto message = decode_message<images_t>({event->data.data(), event->data.size()});
    EXPECT_EQ(message.utime, numbered_frame(i).id.utime);
    EXPECT_EQ(read_camera_metadata(message), kImportedCamera);
    EXPECT_EQ(read_sequence_number(message), i);
  }
}

TEST(ImportLog, KeepsWhatIsGoodAndSaysWhatIsLost) {
  const fs::path folder = fresh_folder("import_damaged");
  TestLog log(folder / "log");
  for (int i = 0; i < 4; ++i) {
    images_t message = foreign_images(numbered_frame(i));
    if (i == 1) message.image_types[1] = images_t::DISPARITY;
    log.add("OPENNI_FRAME", message);
  }
  log.close();
  fs::resize_file(folder / "log", fs::file_size(folder / "log") - 100);
  LossReport losses;
  RecordingSettings settings;
  settings.source = (folder / "log").string();
  EXPECT_EQ(import_log(settings, "FRAMES", folder / "out", losses), 2);
  EXPECT_EQ(losses.damaged_places(), 1);
  EXPECT_EQ(losses.refused(), 1);
  EXPECT_NE(losses.line().find("no DEPTH_MM image"), std::string::npos) << losses.line();
}

TEST(ImportLog, RefusesWhatMakesNoSense) {
  const fs::path folder = fresh_folder("import_refused");
  LossReport losses;
  RecordingSettings settings;
  settings.source = log_of(folder, kImported, "OPENNI_FRAME", foreign_images);
  EXPECT_THROW(import_log(settings, "FRAMES", settings.source, losses), InputError) << "the log itself";
  for (const std::string& channel : {std::string(), std::string(64, 'x')})
    EXPECT_THROW(import_log(settings, channel, folder / "out", losses), InputError) << "LCM cannot send on it";
  BopWriter writer(folder / "scene");
  writer.add(numbered_frame(0), {}, {});
  writer.finish();
  RecordingSettings scene;
  scene.source = "bop:" + (folder / "scene").string();
  const std::string camera = read_text(folder / "scene/scene_camera.json");
  EXPECT_THROW(import_log(scene, "FRAMES", folder / "scene/scene_camera.json", losses), InputError);
  EXPECT_EQ(read_text(folder / "scene/scene_camera.json"), camera) << "a file of the scene";
  settings.channel = "NOTHING";
  EXPECT_THROW(import_log(settings, "FRAMES", folder / "out", losses), InputError);
  EXPECT_FALSE(fs::exists(folder / "out")) << "nothing is written where there are no frames";
  settings.channel.clear();
  settings.camera = Camera{640, 480, 525, 525, 319.5, 239.5};
  EXPECT_THROW(import_log(settings, "FRAMES", folder / "out", losses), InputError) << "a camera of another size";
  settings.source = "fax:" + folder.string();
  EXPECT_THROW(import_log(settings, "FRAMES", folder / "out", losses), InputError);
}

}  // namespace

}  // namespace houghstream::log_tools
