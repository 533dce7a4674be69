#include "drivers/openni/device_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace houghstream::openni {
namespace {

constexpr std::int64_t kPeriod = 33'333;
constexpr std::int64_t kEpoch = 1'700'000'000'000'000;

/// A device whose images take 2 ms to the host, and up to 20 ms more.
struct Device {
  std::int64_t shutter = kEpoch;  // on the host's clock
  std::int64_t zero = kEpoch - 5'000'000;
  double drift_ppm = 0.0;
  std::mt19937 random{1};

  std::uint64_t device_time() const {
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(shutter - zero) * (1.0 + 1e-6 * drift_ppm)));
  }
  std::int64_t arrival() { return shutter + 2'000 + static_cast<std::int64_t>(random() % 20'000); }

  /// Returns the clock's delay of the next image relative to its shutter, microseconds.
  std::int64_t error_of_next(DeviceClock& clock) {
    shutter += kPeriod;
    return clock.utime(device_time(), arrival()) - shutter;
  }
  std::int64_t worst_of(DeviceClock& clock, int images) {
    std::int64_t worst = 0;
    for (int i = 0; i < images; ++i) worst = std::max(worst, std::abs(error_of_next(clock)));
    return worst;
  }
};

TEST(DeviceClock, TheJitterOfTheArrivalIsFilteredOut) {
  DeviceClock clock;
  Device device;
  device.worst_of(clock, 60);
  EXPECT_LT(device.worst_of(clock, 300), 4'500) << "2 ms of them are the way, which nobody can see";
}

TEST(DeviceClock, ADriftingClockIsFollowed) {
  for (const double drift : {-200.0, 200.0}) {
    DeviceClock clock;
    Device device;
    device.drift_ppm = drift;
    device.worst_of(clock, 60);
    EXPECT_LT(device.worst_of(clock, 30 * 600), 6'000) << "after ten minutes it is 120 ms off";
  }
}

TEST(DeviceClock, ACountOf32BitsMayWrap) {
  DeviceClock clock;
  Device device;
  device.worst_of(clock, 60);
  constexpr std::int64_t kWrap = std::int64_t{1} << 32;
  device.zero = device.shutter - kWrap + 30 * kPeriod;
  DeviceClock wrapping;
  std::int64_t last = 0;
  for (int i = 0; i < 300; ++i) {
    device.shutter += kPeriod;
    const std::int64_t utime = wrapping.utime(device.device_time() & 0xffffffffU, device.arrival());
    if (i > 60) {
      EXPECT_LT(std::abs(utime - device.shutter), 4'500) << i;
    }
    EXPECT_GT(utime, last);
    last = utime;
  }
}

TEST(DeviceClock, AClockThatJumpsIsFollowed) {
  for (const std::int64_t jump : {-3'000'000L, -50'000L, 150'000L, 3'600'000'000L}) {
    DeviceClock clock;
    Device device;
    device.worst_of(clock, 100);
    device.zero -= jump;  // the device now counts `jump` more
    device.worst_of(clock, DeviceClock::kLateInARow);
    EXPECT_LT(device.worst_of(clock, 300), 23'000) << jump;
    device.worst_of(clock, 60);
    EXPECT_LT(device.worst_of(clock, 100), 4'500) << jump;
  }
}

TEST(DeviceClock, AStandstillOfTheDevicesClockIsFollowed) {
  DeviceClock clock;
  Device device;
  device.worst_of(clock, 100);
  device.shutter += 500'000;
  device.zero += 500'000;
  device.worst_of(clock, DeviceClock::kLateInARow);
  EXPECT_LT(device.worst_of(clock, 300), 23'000);
}

TEST(DeviceClock, AHiccupOfTheHostChangesNothing) {
  DeviceClock clock;
  Device device;
  device.worst_of(clock, 100);
  device.shutter += kPeriod;
  EXPECT_LT(std::abs(clock.utime(device.device_time(), device.shutter + 900'000) - device.shutter), 4'500);
  device.shutter += 900'000;
  EXPECT_LT(device.worst_of(clock, 100), 4'500);
}

/// The host's clock is set by `step`; all that is seen of the device is that its images arrive at other times.
void set_host_clock(Device& device, std::int64_t step) {
  device.shutter += step;
  device.zero += step;
}

TEST(DeviceClock, AHostClockThatIsSetIsFollowedWithinASecond) {
  constexpr std::int64_t kHour = 3'600'000'000;
  constexpr int kImagesOfASecond = 30;
  for (const std::int64_t step : {-kHour, kHour, -700'000L, -400'000L, -100'000L, -30'000L, 400'000L}) {
    DeviceClock clock;
    Device device;
    device.worst_of(clock, 100);
    set_host_clock(device, step);
    device.worst_of(clock, kImagesOfASecond);
    EXPECT_LT(device.worst_of(clock, 300), 23'000) << step;
  }
}

TEST(DeviceClock, TimesRiseWhileTheHostsClockCatchesUpAfterASmallStepBack) {
  for (const std::int64_t step : {-499'000L, -100'000L, -10'000L}) {
    DeviceClock clock;
    Device device;
    device.worst_of(clock, 100);
    std::int64_t last = device.shutter + device.error_of_next(clock);
    set_host_clock(device, step);
    for (int i = 0; i < 60; ++i) {
      const std::int64_t error = device.error_of_next(clock);
      EXPECT_GE(device.shutter + error - last, kPeriod / 4) << step << " " << i;
      last = device.shutter + error;
    }
  }
}

TEST(DeviceClock, AClockThatWasSetBackWhileTheDeviceWasAwayIsFollowed) {
  DeviceClock clock;
  Device device;
  device.worst_of(clock, 100);
  clock.restart();
  set_host_clock(device, -10'000'000);
  device.zero = device.shutter - 1'000;
  EXPECT_LT(std::abs(device.error_of_next(clock)), 23'000);
}

TEST(DeviceClock, TimesRiseOverARestart) {
  DeviceClock clock;
  const std::int64_t first = clock.utime(1'000, kEpoch);
  EXPECT_EQ(first, kEpoch);
  clock.restart();
  EXPECT_GT(clock.utime(0, kEpoch - 100'000), first);
}

}  // namespace
}  // namespace houghstream::openni
