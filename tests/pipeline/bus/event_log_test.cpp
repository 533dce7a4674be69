#include "pipeline/bus/event_log.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <lcm/lcm-cpp.hpp>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

class EventLogFile : public testing::Test {
 protected:
  EventLogFile() : file(std::filesystem::temp_directory_path() / ("event_log_test." + std::to_string(getpid()))) {}
  ~EventLogFile() override { std::filesystem::remove(file); }

  void write_three() const {
    LogWriter writer(file);
    for (std::int64_t i = 0; i < 3; ++i) {
      const std::vector<std::uint8_t> data(10, static_cast<std::uint8_t>(i));
      writer.write(1000 + i, "CHANNEL", {data.data(), data.size()});
    }
    writer.close();
  }

  const std::filesystem::path file;
};

std::string refusal_after(const std::filesystem::path& file, int good_events) {
  try {
    LogReader reader(file);
    for (int i = 0; i < good_events; ++i) EXPECT_TRUE(reader.next().has_value());
    reader.next();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "a damaged log was read to its end";
  return "";
}

TEST_F(EventLogFile, IsReadByLcm) {
  write_three();
  lcm::LogFile log(file.string(), "r");
  ASSERT_TRUE(log.good());
  for (int i = 0; i < 3; ++i) {
    const lcm::LogEvent* event = log.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, i);
    EXPECT_EQ(event->timestamp, 1000 + i);
    EXPECT_EQ(event->channel, "CHANNEL");
    ASSERT_EQ(event->datalen, 10);
    EXPECT_EQ(static_cast<const std::uint8_t*>(event->data)[9], i);
  }
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST_F(EventLogFile, HasNoChannelThatItsReaderRefuses) {
  LogWriter writer(file);
  const std::uint8_t byte = 0;
  EXPECT_THROW(writer.write(1000, "", {&byte, 1}), InputError);
  EXPECT_THROW(writer.write(1000, std::string(1000, 'x'), {&byte, 1}), InputError);
  writer.write(1000, std::string(999, 'x'), {&byte, 1});
  writer.close();
  LogReader reader(file);
  EXPECT_TRUE(reader.next().has_value());
  EXPECT_FALSE(reader.next().has_value());
}

TEST_F(EventLogFile, IsReadBack) {
  write_three();
  LogReader reader(file);
  for (int i = 0; i < 3; ++i) {
    const std::optional<LogEvent> event = reader.next();
    ASSERT_TRUE(event.has_value());
    EXPECT_EQ(event->timestamp, 1000 + i);
    EXPECT_EQ(event->channel, "CHANNEL");
    EXPECT_EQ(event->data, std::vector<std::uint8_t>(10, static_cast<std::uint8_t>(i)));
  }
  EXPECT_FALSE(reader.next().has_value());
}

TEST_F(EventLogFile, ACutLogIsReportedNotEnded) {
  write_three();
  const auto size = std::filesystem::file_size(file);
  std::filesystem::resize_file(file, size - 4);
  EXPECT_NE(refusal_after(file, 2).find("cut in event 2"), std::string::npos);
  std::filesystem::resize_file(file, size - 20);
  EXPECT_NE(refusal_after(file, 2).find("cut"), std::string::npos);
}

TEST_F(EventLogFile, ADamagedLogIsReported) {
  write_three();
  {
    std::fstream log(file, std::ios::in | std::ios::out | std::ios::binary);
    log.seekp(45);  // the second event's sync word
    log.put('x');
  }
  EXPECT_NE(refusal_after(file, 1).find("no event header at byte 45"), std::string::npos);
}

// Each event of write_three() takes 45 bytes: header 28, channel 7, data 10.
constexpr std::streamoff kEventBytes = 45;

void put_at(const std::filesystem::path& file, std::streamoff position, char value) {
  std::fstream log(file, std::ios::in | std::ios::out | std::ios::binary);
  log.seekp(position);
  log.put(value);
}

TEST_F(EventLogFile, WhatFollowsADamagedEventIsRead) {
  write_three();
  put_at(file, kEventBytes, 'x');
  LogReader reader(file);
  EXPECT_EQ(reader.next()->timestamp, 1000);
  EXPECT_THROW(reader.next(), InputError);
  const LogReader::Damage damage = reader.skip_damage();
  EXPECT_EQ(damage.bytes, 45U);
  EXPECT_FALSE(damage.last_event_too);
  EXPECT_EQ(reader.next()->timestamp, 1002);
  EXPECT_FALSE(reader.next().has_value());
}

TEST_F(EventLogFile, AWrongLengthDoesNotSwallowTheNextEvent) {
  write_three();
  put_at(file, kEventBytes - 17 - 1, 10 + 20);  // the first event's data would reach into the second
  LogReader reader(file);
  EXPECT_EQ(reader.next()->timestamp, 1000);
  EXPECT_THROW(reader.next(), InputError);
  const LogReader::Damage damage = reader.skip_damage();
  EXPECT_TRUE(damage.last_event_too);
  EXPECT_EQ(damage.bytes, 45U);
  EXPECT_EQ(reader.next()->timestamp, 1001);
  EXPECT_EQ(reader.next()->timestamp, 1002);
}

TEST_F(EventLogFile, DamageUpToTheEndIsPassedOver) {
  write_three();
  std::filesystem::resize_file(file, 2 * kEventBytes + 30);
  LogReader reader(file);
  reader.next();
  reader.next();
  EXPECT_THROW(reader.next(), InputError);
  EXPECT_EQ(reader.skip_damage().bytes, 30U);
  EXPECT_FALSE(reader.next().has_value());
}

// The write fails as on a disk that is full for a while.
TEST_F(EventLogFile, ALogThatLacksAnEventIsNotPublished) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const std::vector<std::uint8_t> data(100'000, 7);
  LogWriter writer(file);
  writer.write(1, "CHANNEL", {data.data(), data.size()});
  rlimit full = before;
  full.rlim_cur = 150'000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  EXPECT_THROW(writer.write(2, "CHANNEL", {data.data(), data.size()}), InputError);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_NO_THROW(writer.write(3, "CHANNEL", {data.data(), 10}));
  EXPECT_THROW(writer.close(), InputError);
  std::signal(SIGXFSZ, SIG_DFL);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(EventLogFile, FilesThatAreNoLogsAreRefused) {
  EXPECT_THROW(LogReader(file / "missing"), InputError);
  EXPECT_THROW(LogWriter(file / "missing" / "too"), InputError);
  std::ofstream(file).close();
  EXPECT_THROW(LogReader{file}, InputError);
  std::ofstream(file) << "this is a text file, and certainly not a log";
  EXPECT_NE(refusal_after(file, 0).find("no event header"), std::string::npos);
  EXPECT_THROW(LogReader{std::filesystem::temp_directory_path()}, InputError);
}

}  // namespace
}  // namespace houghstream
