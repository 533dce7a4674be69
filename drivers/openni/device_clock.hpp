#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace houghstream::openni {

/// Maps a device's clock to the host's. A device counts microseconds from a zero of its own, and its clock runs a
/// little fast or slow; the host knows only when an image arrived, which is late by a varying time. The smallest
/// lateness of the last seconds changes little: it is taken as the offset between the clocks, so that the capture
/// times keep the device's even spacing. What is constant in the way from the shutter to the host cannot be seen.
class DeviceClock {
 public:
  /// Returns the utime (microseconds since the epoch) of the image with this device time that arrived at `host_us`, the
  /// host's time since the epoch. It is never later than the arrival but for the second after the host's clock was set
  /// back. It rises from call to call but where that clock is set back by more than kSlewUs: these utimes follow it at
  /// once. After a smaller step they run at a quarter of the speed at least until the host's clock has reached them. A
  /// device clock that wraps at 32 bits continues; one that jumps is followed, at once where the jump is evident (times
  /// fall, or images would come from the future), else after kLateInARow images. A host's clock that is set forward is
  /// followed likewise.
  std::int64_t utime(std::uint64_t device_us, std::int64_t host_us);

  /// Forgets the offset, since another device, or the same one after a restart, has another. utimes continue from the
  /// last one.
  void restart();

  static constexpr std::int64_t kWindowUs = 2'000'000;  ///< 100 ppm of drift make 0.2 ms in it
  static constexpr std::int64_t kLateUs = 100'000;      ///< later than the window's offset: a hiccup, or a jump
  static constexpr int kLateInARow = 5;                 ///< a hiccup of the host does not delay so many images evenly
  static constexpr std::int64_t kSlewUs = 500'000;      ///< caught up with within 0.7 s

 private:
  struct Sample {
    std::int64_t host_us = 0;
    std::int64_t offset_us = 0;
  };

  std::int64_t unwrapped(std::uint64_t device_us, std::int64_t host_us);
  std::int64_t filtered_offset(const Sample& sample);
  /// The utime that follows the last one, `interval` after it by the device's clock.
  std::int64_t slewed(std::int64_t utime, std::int64_t interval) const;

  std::deque<Sample> window_;    // offsets rise from front to back: the front is the smallest
  std::int64_t wrapped_us_ = 0;  // sum of the wraps of the device's count
  int late_in_a_row_ = 0;
  std::optional<std::int64_t> last_device_us_;
  std::int64_t last_host_us_ = 0;
  std::optional<std::int64_t> last_utime_;
};

}  // namespace houghstream::openni
