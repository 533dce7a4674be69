#include "tools/log/export_objects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tests/test_files.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

WorldObjects world_with(TrackState state, std::int64_t utime, const std::string& reason) {
  TrackedObject mug;
  mug.track_id = 3;
  mug.class_id = 2;
  mug.class_name = "mug";
  mug.state = state;
  mug.probability = 0.5F;
  mug.T_world_object = Eigen::Isometry3d(Eigen::Translation3d(0.25, 0, 1));
  mug.covariance(0, 0) = 0.0625;
  mug.last_seen = {"LEFT", 1};
  mug.reason = reason;
  WorldObjects world;
  world.frame = {"LEFT", utime};
  world.world = "WORLD";
  world.objects = {mug};
  return world;
}

fs::path log_of_three_frames() {
  fs::path file = fresh_folder("export_objects") / "objects.lcmlog";
  LogWriter writer(file);
  for (const WorldObjects& world :
       {world_with(TrackState::kVisible, 1, "seen by LEFT"), world_with(TrackState::kVisible, 2, "seen by LEFT"),
        world_with(TrackState::kGone, 3, "LEFT sees through, 90 % of it")}) {
    const std::vector<std::uint8_t> bytes = encode_message(to_message(world));
    writer.write(world.frame.utime, channel::kObjects, {bytes.data(), bytes.size()});
  }
  writer.close();
  return file;
}

TEST(ExportObjects, CsvHasARowForEachObjectOfEachFrame) {
  LossReport losses;
  const fs::path log = log_of_three_frames();
  const fs::path out = log.parent_path() / "out.csv";
  EXPECT_EQ(export_objects_csv(log, out, losses), 3);
  std::ifstream in(out);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[1].substr(0, 58), "1,LEFT,WORLD,1,3,2,mug,visible,0.5,0,0.25,0,1,1,0,0,0,0.25");
  EXPECT_NE(lines[3].find("gone"), std::string::npos);
  EXPECT_NE(lines[3].find("\"LEFT sees through, 90 % of it\""), std::string::npos);
  EXPECT_EQ(std::count(lines[0].begin(), lines[0].end(), ','), std::count(lines[1].begin(), lines[1].end(), ','));
}

TEST(ExportObjects, JsonTellsEachObjectsStoryAndWhyItVanished) {
  LossReport losses;
  const fs::path log = log_of_three_frames();
  const fs::path out = log.parent_path() / "out.json";
  EXPECT_EQ(export_objects_json(log, out, losses), 3);
  const nlohmann::json json = read_json_object(out);
  ASSERT_EQ(json["stories"].size(), 1U);
  const auto& states = json["stories"][0]["states"];
  ASSERT_EQ(states.size(), 2U);
  EXPECT_EQ(states[0]["state"], "visible");
  EXPECT_EQ(states[1]["state"], "gone");
  EXPECT_EQ(states[1]["utime"], 3);
  EXPECT_EQ(states[1]["reason"], "LEFT sees through, 90 % of it");
  EXPECT_EQ(json["frames"].size(), 3U);
  EXPECT_EQ(json["frames"][0]["objects"][0]["pose"][0], 0.25);
}

TEST(ExportObjects, AreNotWrittenOverTheirLogAndAreThereAsAWhole) {
  LossReport losses;
  const fs::path log = log_of_three_frames();
  const std::string before = read_text(log);
  const fs::path out = log.parent_path() / "out";
  fs::create_symlink(log, log.parent_path() / "link");
  EXPECT_THROW(export_objects_csv(log, log, losses), InputError);
  EXPECT_THROW(export_objects_csv(log, log.parent_path() / "link", losses), InputError);
  EXPECT_THROW(export_objects_json(log, log, losses), InputError);
  EXPECT_EQ(read_text(log), before);
  const AtomicFile held(out);
  EXPECT_THROW(export_objects_csv(log, out, losses), InputError) << "somebody else writes it";
}

TEST(ExportObjects, ALogWithoutObjectsIsRefused) {
  const fs::path file = fresh_folder("export_no_objects") / "frames.lcmlog";
  LogWriter writer(file);
  const std::vector<std::uint8_t> bytes = {1, 2, 3};
  writer.write(1, "OTHER", {bytes.data(), bytes.size()});
  writer.close();
  LossReport losses;
  EXPECT_NE(error_of([&] {
              export_objects_csv(file, file.parent_path() / "out.csv", losses);
            }).find("no message on HOUGHSTREAM_OBJECTS, expected objects of hs-track"),
            std::string::npos);
}

}  // namespace
}  // namespace houghstream::log_tools
