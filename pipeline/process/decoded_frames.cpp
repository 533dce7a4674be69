#include "pipeline/process/decoded_frames.hpp"

#include <algorithm>

#include "pipeline/messages/messages.hpp"

namespace houghstream {
namespace {

std::size_t image_bytes(const RgbdFrame& frame) {
  return frame.colour.total() * frame.colour.elemSize() + frame.depth.total() * frame.depth.elemSize();
}

}  // namespace

RgbdFrame decode_frame(ByteView bytes, const std::string& channel, const std::optional<Camera>& camera,
                       const std::string& stage) {
  StageClock clock;
  RgbdFrame frame = frame_from_message(decode_message<images_t>(bytes), channel, camera);
  clock.mark(stage);
  frame.stages.push_back(clock.times().front());
  return frame;
}

DecodedFrames::Decoded DecodedFrames::decode(const SharedBytes& bytes, const std::string& channel) {
  if (Decoded known = find(bytes)) return known;
  const auto frame =
      std::make_shared<const RgbdFrame>(decode_frame({bytes->data(), bytes->size()}, channel, camera_, stage_));
  store(bytes, frame);
  return frame;
}

DecodedFrames::Decoded DecodedFrames::find(const SharedBytes& bytes) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found =
      std::find_if(frames_.rbegin(), frames_.rend(), [&](const Entry& entry) { return entry.bytes.lock() == bytes; });
  return found == frames_.rend() ? nullptr : found->frame;
}

void DecodedFrames::store(const SharedBytes& bytes, const Decoded& frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  bytes_ += image_bytes(*frame);
  frames_.push_back({bytes, frame});
  while (frames_.size() > kFrames || (frames_.size() > 1 && bytes_ > kBytes)) {
    bytes_ -= image_bytes(*frames_.front().frame);
    frames_.pop_front();
  }
}

}  // namespace houghstream
