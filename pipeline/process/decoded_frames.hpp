#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "pipeline/messages/wire_reader.hpp"
#include "pipeline/process/reception.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Decodes an images_t that came on this channel; the time that this took is appended to the frame's stages under the
/// name `stage`. Throws InputError where the bytes are no images_t.
RgbdFrame decode_frame(ByteView bytes, const std::string& channel, const std::optional<Camera>& camera,
                       const std::string& stage);

/// The last decoded frames of all cameras, so that a frame is decoded once: ahead, or at its first use. May be used
/// from any thread.
class DecodedFrames {
 public:
  using Decoded = std::shared_ptr<const RgbdFrame>;

  /// A decoded frame has some megabytes, and an untrusted sender may make up channels without end.
  static constexpr std::size_t kFrames = 12;
  static constexpr std::size_t kBytes = std::size_t{192}
                                        << 20U;  ///< maximum of their images; the newest frame stays in any case

  /// `camera` and `stage` are passed to decode_frame().
  DecodedFrames(std::optional<Camera> camera, std::string stage)
      : camera_(std::move(camera)), stage_(std::move(stage)) {}

  /// Returns the frame that these very bytes encode, not another one of the same id. Throws InputError where they are
  /// no images_t.
  Decoded decode(const SharedBytes& bytes, const std::string& channel);

 private:
  struct Entry {
    std::weak_ptr<const std::vector<std::uint8_t>> bytes;  // message from which it was decoded
    Decoded frame;
  };

  Decoded find(const SharedBytes& bytes) const;
  void store(const SharedBytes& bytes, const Decoded& frame);

  std::optional<Camera> camera_;
  std::string stage_;
  mutable std::mutex mutex_;
  std::deque<Entry> frames_;
  std::size_t bytes_ = 0;
};

}  // namespace houghstream
