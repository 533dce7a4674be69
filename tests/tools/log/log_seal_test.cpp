#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/bus/event_log.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/log/recordings.hpp"
#include "tools/log/good_events.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

class SealLog : public testing::Test {
 protected:
  /// Frames with JPEG and zlib, and small messages: more than a block.
  SealLog() : folder(fresh_folder("seal_log")), original(folder / "original"), sealed(folder / "sealed") {
    TestLog log(original);
    for (int i = 0; i < 20; ++i) log.add("OPENNI_FRAME", to_message(numbered_frame(i), {}, i));
    for (std::size_t i = 0; i < kSealedBlock; ++i) log.add_bytes("SMALL", {static_cast<std::uint8_t>(i), 2, 3});
    log.close();
    seal_log(original, sealed, [this](double fraction) { shares.push_back(fraction); });
  }

  /// Events of a log that can be read, and what is said of the rest.
  static std::pair<int, std::string> read(const fs::path& file) {
    LossReport losses;
    IntactEvents events(file, losses);
    int count = 0;
    while (events.next()) ++count;
    return {count, losses.line()};
  }

  fs::path folder;
  fs::path original;
  fs::path sealed;
  std::vector<double> shares;  // values that were reported
};

TEST_F(SealLog, KeepsEveryEvent) {
  LogReader before(original);
  LogReader after(sealed);
  while (const std::optional<LogEvent> event = before.next()) {
    const std::optional<LogEvent> same = after.next();
    ASSERT_TRUE(same.has_value());
    EXPECT_EQ(same->timestamp, event->timestamp);
    EXPECT_EQ(same->channel, event->channel);
    EXPECT_EQ(same->data, event->data);
  }
  EXPECT_FALSE(after.next().has_value()) << "seals are not among them";
}

TEST_F(SealLog, TellsHowFarItIs) {
  ASSERT_EQ(shares.size(), 20 + kSealedBlock);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GT(shares.front(), 0.0);
  EXPECT_DOUBLE_EQ(shares.back(), 1.0);
}

TEST_F(SealLog, EveryFlippedBitIsFound) {
  const std::string whole = read_file(sealed, "a log");
  const int events = read(sealed).first;
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    std::string bytes = whole;
    bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
    write_file_atomically(folder / "damaged", bytes);
    const auto [kept, words] = read(folder / "damaged");
    // An event's number in its header is nobody's business: LCM counts anew.
    if (words.empty()) {
      EXPECT_EQ(kept, events);
    }
    if (!words.empty()) {
      EXPECT_LT(kept, events + 1) << words;
    }
  }
  std::string jpeg = whole;
  jpeg[whole.find("\xFF\xDA") + 40] ^= 4;
  write_file_atomically(folder / "damaged", jpeg);
  const auto [kept, words] = read(folder / "damaged");
  EXPECT_EQ(kept, events - 1);
  EXPECT_NE(words.find("checksum"), std::string::npos) << words;
}

TEST_F(SealLog, MissingEventsAreFound) {
  const std::string whole = read_file(sealed, "a log");
  write_file_atomically(folder / "cut", whole.substr(0, whole.size() - (28 + 5 + 3)));  // the last event
  LogReader log(folder / "cut");
  EXPECT_THROW(while (log.next()){}, InputError);
  EXPECT_NE(read(folder / "cut").second.find("1 sealed event"), std::string::npos) << read(folder / "cut").second;
}

TEST_F(SealLog, WhatIsDamagedIsNotSealed) {
  const std::string whole = read_file(original, "a log");
  write_file_atomically(folder / "cut", whole.substr(0, whole.size() - 2));
  EXPECT_THROW(seal_log(folder / "cut", folder / "out"), InputError);
  EXPECT_FALSE(fs::exists(folder / "out"));
  EXPECT_THROW(seal_log(original, original), InputError);
}

}  // namespace
}  // namespace houghstream::log_tools
