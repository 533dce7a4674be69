#include "pipeline/bus/lcm_bus.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

#include "pipeline/bus/channels.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

detections_t numbered(std::int64_t utime) {
  Detections detections;
  detections.utime = utime;
  return to_message(detections);
}

TEST(LcmBus, CarriesMessages) {
  LcmBus bus("memq://");
  std::int64_t seen = 0;
  bus.subscribe("X", [&](const Arrival& arrival) { seen = decode_message<detections_t>(arrival.bytes).utime; });
  bus.publish("X", numbered(42));
  EXPECT_TRUE(bus.handle(milliseconds(100)));
  EXPECT_EQ(seen, 42);
  EXPECT_FALSE(bus.is_log());
}

TEST(LcmBus, ThrowingHandlersDoNotStopIt) {
  LcmBus bus("memq://");
  int calls = 0;
  bus.subscribe("X", [&](const Arrival&) {
    ++calls;
    throw std::runtime_error("handler failed");
  });
  bus.publish("X", numbered(1));
  bus.publish("X", numbered(2));
  EXPECT_TRUE(bus.handle(milliseconds(100)));
  EXPECT_TRUE(bus.handle(milliseconds(100)));
  EXPECT_EQ(calls, 2);
}

TEST(LcmBus, RefusesWhatItCannotOpen) {
  EXPECT_THROW(LcmBus("nosuch://"), InputError);
  EXPECT_THROW(LcmBus("file:///no/such/log"), InputError);
  EXPECT_THROW(LcmBus("memq://", "results.log"), InputError);
}

TEST(LcmBus, ReadsALogWithoutSkippingAndWritesAnother) {
  const auto folder = std::filesystem::temp_directory_path();
  const auto input = folder / ("lcm_bus_test_in." + std::to_string(getpid()));
  const auto output = folder / ("lcm_bus_test_out." + std::to_string(getpid()));
  LogWriter writer(input);
  for (std::int64_t i = 0; i < 200; ++i) {
    const std::vector<std::uint8_t> bytes = encode_message(numbered(i));
    writer.write(i, i % 2 == 0 ? "X" : "Y", {bytes.data(), bytes.size()});
  }
  writer.close();

  LcmBus bus("file://" + input.string() + "?speed=0", output.string());
  EXPECT_TRUE(bus.is_log());
  std::vector<std::int64_t> utimes;
  bus.subscribe("X", [&](const Arrival& arrival) {
    utimes.push_back(read_utime(arrival.bytes, arrival.channel));
    bus.publish("Z", numbered(utimes.back()));
  });
  while (bus.handle(milliseconds(0))) {
  }
  bus.close();
  EXPECT_EQ(utimes.size(), 100U);
  LogReader reader(output);
  const std::optional<LogEvent> first = reader.next();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->channel, "Z");
  EXPECT_EQ(reader.next()->timestamp, 2);

  LcmBus read_only("file://" + input.string());
  EXPECT_THROW(read_only.publish("Z", numbered(1)), InputError);
  std::filesystem::remove(input);
  std::filesystem::remove(output);
}

}  // namespace
}  // namespace houghstream
