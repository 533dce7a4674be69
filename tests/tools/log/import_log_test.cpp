#include "tools/log/import_log.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/log/recordings.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 3;
const Camera kCamera = make_test_frame(0).camera;

TEST(ImportLog, KeepsTimesAndAddsWhatIsMissing) {
  const fs::path folder = fresh_folder("import_keeps");
  LossReport losses;
  RecordingSettings settings;
  settings.source = log_of(folder, kFrames, "OPENNI_FRAME", foreign_images);
  settings.camera = kCamera;
  import_log(settings, "MINE", folder / "out", losses);
  LogReader log(folder / "out");
  for (int i = 0; i < kFrames; ++i) {
    const auto event = log.next();
    ASSERT_TRUE(event.has_value());
    EXPECT_EQ(event->channel, "MINE");
    EXPECT_EQ(event->timestamp, 1'500'000'000'000'000 + 33'000 * 2 * i);
    const auto message = decode_message<images_t>({event->data.data(), event->data.size()});
    EXPECT_EQ(message.utime, numbered_frame(i).id.utime);
    EXPECT_EQ(camera_of(message), kCamera);
    EXPECT_EQ(sequence_of(message), i);
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
  settings.source = log_of(folder, kFrames, "OPENNI_FRAME", foreign_images);
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
