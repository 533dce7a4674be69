#include "drivers/openni/device_clock.hpp"

#include <algorithm>
#include <cstdlib>

namespace houghstream::openni {
namespace {

constexpr std::int64_t kWrapUs = std::int64_t{1} << 32;
// Difference between the device's interval over a wrap and the host's.
constexpr std::int64_t kWrapToleranceUs = 1'000'000;

}  // namespace

std::int64_t DeviceClock::utime(std::uint64_t device_us, std::int64_t host_us) {
  const std::int64_t device = unwrapped(device_us, host_us);
  std::int64_t interval = last_device_us_ ? device - *last_device_us_ : 0;
  if (interval - (host_us - last_host_us_) > kSlewUs) interval = 0;  // one of the clocks has jumped
  const std::int64_t offset = filtered_offset({host_us, host_us - device});
  last_device_us_ = device;
  last_host_us_ = host_us;
  last_utime_ = slewed(device + offset, interval);
  return *last_utime_;
}

std::int64_t DeviceClock::slewed(std::int64_t utime, std::int64_t interval) const {
  constexpr std::int64_t kSlowest = 4;
  if (!last_utime_ || utime < *last_utime_ - kSlewUs) return utime;
  return std::max(utime, *last_utime_ + std::max<std::int64_t>(1, interval / kSlowest));
}

void DeviceClock::restart() {
  window_.clear();
  wrapped_us_ = 0;
  late_in_a_row_ = 0;
  last_device_us_.reset();
}

std::int64_t DeviceClock::unwrapped(std::uint64_t device_us, std::int64_t host_us) {
  const std::int64_t device = static_cast<std::int64_t>(device_us) + wrapped_us_;
  if (!last_device_us_ || device >= *last_device_us_) return device;
  const std::int64_t over_the_wrap = device + kWrapUs - *last_device_us_;
  if (std::abs(over_the_wrap - (host_us - last_host_us_)) < kWrapToleranceUs) {
    wrapped_us_ += kWrapUs;
    return device + kWrapUs;
  }
  restart();
  return static_cast<std::int64_t>(device_us);
}

std::int64_t DeviceClock::filtered_offset(const Sample& sample) {
  while (!window_.empty() && window_.front().host_us < sample.host_us - kWindowUs) window_.pop_front();
  const bool late = !window_.empty() && sample.offset_us > window_.front().offset_us + kLateUs;
  late_in_a_row_ = late ? late_in_a_row_ + 1 : 0;
  if (late_in_a_row_ >= kLateInARow) {
    window_.clear();
    late_in_a_row_ = 0;
  }
  while (!window_.empty() && window_.back().offset_us >= sample.offset_us) window_.pop_back();
  window_.push_back(sample);
  return window_.front().offset_us;
}

}  // namespace houghstream::openni
