#include "tools/log/export_mcap.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/messages/channels.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/log/foreign_frames.hpp"
#include "tests/tools/log/recordings.hpp"

// Contents are checked by mcap_test, with the reader of MCAP's own project.

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

images_t encoded_frame(const RgbdFrame& frame) {
  return to_message(frame, WireFormat(), 0);
}

TEST(ExportMcap, TakesFramesOfAllKindsAndCountsWhatItCannotRead) {
  const fs::path folder = fresh_folder("export_mcap");
  TestLog log(folder / "in.lcmlog");
  log.add("FRAMES", encoded_frame(numbered_frame(0)));
  log.add("KINECT_FRAME", kinect_message(numbered_frame(1), true));
  images_t damaged = encoded_frame(numbered_frame(2));
  damaged.images[0].data.resize(50);
  damaged.images[0].size = 50;
  log.add("FRAMES", damaged);
  log.add_bytes(channel::kDetections, {1, 2, 3});
  log.add("FRAMES", encoded_frame(numbered_frame(3)));
  log.close();
  LossReport losses;
  EXPECT_EQ(export_mcap(folder / "in.lcmlog", {}, folder / "out.mcap", losses), 3);
  EXPECT_EQ(losses.refused(), 2) << losses.line();
  const std::string bytes = read_text(folder / "out.mcap");
  EXPECT_EQ(bytes.substr(0, 5), "\x89MCAP");
  EXPECT_NE(bytes.find("/KINECT_FRAME/depth"), std::string::npos) << "the summary is not compressed";
}

TEST(ExportMcap, IsTheSameEachTime) {
  const fs::path folder = fresh_folder("export_mcap_again");
  const std::string log = log_of(folder, 3, "FRAMES", encoded_frame);
  for (const char* name : {"a.mcap", "b.mcap"}) {
    LossReport losses;
    export_mcap(log, {}, folder / name, losses);
  }
  EXPECT_EQ(read_text(folder / "a.mcap"), read_text(folder / "b.mcap"));
}

TEST(ExportMcap, ATimeBeforeTheEpochIsRefused) {
  const fs::path folder = fresh_folder("export_mcap_times");
  RgbdFrame early = numbered_frame(0);
  early.id.utime = -5;
  TestLog log(folder / "in.lcmlog");
  log.add("FRAMES", encoded_frame(early));
  log.close();
  LossReport losses;
  EXPECT_NE(error_of([&] { export_mcap(folder / "in.lcmlog", {}, folder / "out.mcap", losses); }).find("time of -5 us"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "out.mcap"));
}

TEST(ExportMcap, IsNotWrittenOverItsLogNorBesideSomebodyElse) {
  const fs::path folder = fresh_folder("export_mcap_over");
  const std::string log = log_of(folder, 1, "FRAMES", encoded_frame);
  const std::string before = read_text(log);
  LossReport losses;
  EXPECT_THROW(export_mcap(log, {}, log, losses), InputError);
  EXPECT_EQ(read_text(log), before);
  const AtomicFile held(folder / "out.mcap");
  EXPECT_THROW(export_mcap(log, {}, folder / "out.mcap", losses), InputError) << "somebody else writes it";
}

TEST(ExportMcap, ResultsWithoutFramesAreToldToLackImages) {
  const fs::path folder = fresh_folder("export_mcap_results");
  TestLog log(folder / "in.lcmlog");
  const Detections detections{{"FRAMES", 1'000'000}, {}, {}};
  log.add(channel::kDetections, to_message(detections));
  log.close();
  LossReport losses;
  EXPECT_EQ(export_mcap(folder / "in.lcmlog", {}, folder / "out.mcap", losses), 0);
  expect_says(losses.line(), {"no frames in it, so there are no images", "--keep-frames"});
}

TEST(ExportMcap, ALogWithNothingToShowIsRefused) {
  const fs::path folder = fresh_folder("export_mcap_nothing");
  TestLog log(folder / "in.lcmlog");
  log.add_bytes("OTHER", {1, 2, 3});
  log.close();
  LossReport losses;
  EXPECT_EQ(
      error_of([&] { export_mcap(folder / "in.lcmlog", {}, folder / "out.mcap", losses); }),
      (folder / "in.lcmlog").string() +
          ": no frame, detection or object that could be exported; hs-pose --keep-frames keeps these beside its poses");
}

}  // namespace
}  // namespace houghstream::log_tools
