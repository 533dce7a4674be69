#include "tools/log/good_events.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

// An event has a header of 28 bytes, the channel "CHANNEL" of 7, and data of 10.
constexpr std::streamoff kEventBytes = 45;

fs::path write_events(const std::string& name, int events) {
  fs::path file = fresh_folder(name) / "log";
  LogWriter writer(file);
  for (int i = 0; i < events; ++i) {
    const std::vector<std::uint8_t> data(10, static_cast<std::uint8_t>(i));
    writer.write(i, "CHANNEL", {data.data(), data.size()});
  }
  writer.close();
  return file;
}

void put_at(const fs::path& file, std::streamoff position, char value) {
  std::fstream log(file, std::ios::in | std::ios::out | std::ios::binary);
  log.seekp(position);
  log.put(value);
}

std::vector<std::int64_t> read_all(const fs::path& file, LossReport& losses) {
  std::vector<std::int64_t> timestamps;
  IntactEvents events(file, losses);
  while (const auto event = events.next()) timestamps.push_back(event->timestamp);
  return timestamps;
}

using Timestamps = std::vector<std::int64_t>;

TEST(IntactEvents, AHealthyLogIsReadToItsEnd) {
  LossReport losses;
  EXPECT_EQ(read_all(write_events("good_healthy", 3), losses), (Timestamps{0, 1, 2}));
  EXPECT_EQ(losses.line(), "");
}

TEST(IntactEvents, ACutLogLosesItsLastEventOnly) {
  const fs::path file = write_events("good_cut", 4);
  fs::resize_file(file, 4 * kEventBytes - 3);
  LossReport losses;
  EXPECT_EQ(read_all(file, losses), (Timestamps{0, 1, 2}));
  EXPECT_NE(losses.line().find("42 bytes lost at 1 damaged place, first: " + file.string() + ": cut in event 3"),
            std::string::npos)
      << losses.line();
}

TEST(IntactEvents, DamagedPlacesArePassedOver) {
  const fs::path file = write_events("good_damaged", 9);
  put_at(file, 2 * kEventBytes, 'x');           // a sync word
  put_at(file, 5 * kEventBytes + 26, '\x01');   // a length: the event would reach far beyond the end
  put_at(file, 7 * kEventBytes + 27, 10 + 12);  // a length: the event reaches into the next
  LossReport losses;
  EXPECT_EQ(read_all(file, losses), (Timestamps{0, 1, 3, 4, 6, 8}));
  EXPECT_EQ(losses.damaged_places(), 3);
  EXPECT_NE(losses.line().find("135 bytes lost at 3 damaged places"), std::string::npos) << losses.line();
}

TEST(IntactEvents, WhatIsNoLogIsRefused) {
  const fs::path folder = fresh_folder("good_none");
  write_text(folder / "text", std::string(1000, 'x'));
  LossReport losses;
  EXPECT_THROW(read_all(folder / "text", losses), InputError);
  EXPECT_THROW(read_all(folder / "missing", losses), InputError);
}

/// Events one within the other, each up to the last byte but one.
void write_nested(const fs::path& file, std::uint32_t events) {
  constexpr std::uint32_t kEach = 29;
  std::string text;
  const auto put = [&](std::uint64_t number, std::size_t bytes) {
    for (std::size_t i = bytes; i > 0; --i) text += static_cast<char>(number >> (8 * (i - 1)) & 0xFFU);
  };
  for (std::uint32_t i = 0; i < events; ++i) {
    put(0xEDA1DA01U, 4);
    put(i, 8);
    put(i, 8);
    put(1, 4);
    put(kEach * (events - 1 - i), 4);
    text += 'C';
  }
  write_text(file, text + 'x');
}

// Read anew from each of them on, this log of 6 MB would be 600 GB.
TEST(IntactEvents, AForgedLogIsReadAFewTimesOnly) {
  const fs::path file = fresh_folder("good_forged") / "log";
  write_nested(file, 200'000);
  LogReader reader(file);
  std::size_t events = 0;
  for (bool ended = false; !ended;) {
    try {
      ended = !reader.next().has_value();
      if (!ended) ++events;
    } catch (const InputError&) {
      reader.skip_damage();
    }
  }
  EXPECT_GE(events, 1U);
  EXPECT_LE(events, 10U);
}

TEST(IntactEvents, AFileThatIsNoLogIsNamedFirst) {
  const fs::path file = fresh_folder("good_none") / "film.mp4";
  write_text(file, std::string(100, 'x'));
  LossReport losses;
  IntactEvents events(file, losses);
  const std::string error = error_of([&] { events.next(); });
  EXPECT_EQ(error.find(file.string() + ": no event of an LCM log in it"), 0U) << error;
}

TEST(LossReport, SaysInOneLineWhatWasLost) {
  LossReport losses;
  losses.note_refused("frame 7: no camera");
  losses.note_refused("frame 8: no camera");
  EXPECT_EQ(losses.line(), "2 left out, first: frame 7: no camera");
  losses.note_damage(12, "cut");
  EXPECT_EQ(losses.line(), "12 bytes lost at 1 damaged place, first: cut; 2 left out, first: frame 7: no camera");
}

}  // namespace
}  // namespace houghstream::log_tools
