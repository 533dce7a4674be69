#include "tools/log/log_info.hpp"

#include <gtest/gtest.h>

#include <houghstream/status_t.hpp>

#include "tests/test_files.hpp"
#include "tests/tools/log/recordings.hpp"
#include "tools/log/message_types.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

TEST(LogInfo, CountsChannelsTypesRatesAndGaps) {
  const fs::path file = fresh_folder("log_info") / "log";
  LogWriter log(file);
  const auto write = [&](std::int64_t milliseconds, const std::string& channel, const auto& message) {
    const std::vector<std::uint8_t> bytes = encode_message(message);
    log.write(1'500'000'000'000'000 + 1000 * milliseconds, channel, {bytes.data(), bytes.size()});
  };
  for (int i = 0; i < 5; ++i) write(100 * i, "OPENNI_FRAME", to_message(numbered_frame(i), {}, i < 3 ? i : i + 2));
  write(900, "OPENNI_FRAME", to_message(numbered_frame(5), {}, 7));
  write(1000, "KINECT_FRAME", kinect_message(numbered_frame(0), true));
  log.write(1'500'000'000'000'000 + 2'000'000, "ODD", {reinterpret_cast<const std::uint8_t*>("abcdefgh"), 8});
  log.close();

  LossReport losses;
  const LogInfo info = read_log_info(file, losses);
  EXPECT_EQ(losses.line(), "");
  EXPECT_EQ(info.events, 8);
  EXPECT_EQ(info.last - info.first, 2'000'000);
  ASSERT_EQ(info.channels.size(), 3U);
  const ChannelInfo& frames = info.channels.at("OPENNI_FRAME");
  EXPECT_EQ(frames.messages, 6);
  EXPECT_NEAR(frames.rate_hz(), 5 / 0.9, 1e-9);
  EXPECT_EQ(frames.max_gap, 500'000);
  EXPECT_EQ(frames.gap_at - info.first, 900'000);
  EXPECT_EQ(frames.frames_lost, 2);
  const std::string text = to_text(info);
  for (const char* part :
       {"images_t (bot_core)", "frame_msg_t (kinect)", "?? 6162636465666768", "2017-07-14 02:40:00",
        "0.500 s before 0.900 s", "JPEG 64x48, zipped depth 64x48, camera 64x48,57.6,57.6,32,24", "2 frames missing"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
  const OrderedJson json = to_json(info);
  EXPECT_EQ(json["events"], 8);
  EXPECT_EQ(json["duration_s"], 2.0);
  ASSERT_EQ(json["channels"].size(), 3U);
  EXPECT_TRUE(json["channels"][1]["rate_hz"].is_null());  // of a single message
  const OrderedJson& named = json["channels"][2];
  EXPECT_EQ(named["name"], "OPENNI_FRAME");
  EXPECT_EQ(named["longest_gap_s"], 0.5);
  EXPECT_EQ(named["longest_gap_until_utime"], frames.gap_at);
  EXPECT_EQ(named["frames_lost"], 2);
}

TEST(LogInfo, AFrameThatIsDamagedIsCounted) {
  const fs::path file = fresh_folder("log_info_bad") / "log";
  TestLog log(file);
  std::vector<std::uint8_t> bytes = encode_message(foreign_images(numbered_frame(0)));
  log.add_bytes("OPENNI_FRAME", bytes);
  bytes.resize(bytes.size() - 5);
  log.add_bytes("OPENNI_FRAME", bytes);
  log.close();
  LossReport losses;
  const LogInfo info = read_log_info(file, losses);
  EXPECT_EQ(losses.refused(), 1);
  EXPECT_NE(to_text(info).find("raw colour 64x48, zipped depth 64x48, without a camera"), std::string::npos)
      << to_text(info);
}

}  // namespace
}  // namespace houghstream::log_tools
