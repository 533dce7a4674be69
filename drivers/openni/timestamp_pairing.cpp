#include "drivers/openni/timestamp_pairing.hpp"

#include <algorithm>
#include <cstdlib>

namespace houghstream::openni {

RgbdFrame frame_of_pair(const ImagePair& pair, const Camera& camera, std::int64_t utime) {
  RgbdFrame frame;
  frame.id.utime = utime;
  frame.colour = pair.colour.image;
  frame.depth = depth_from_millimetres(pair.depth.image);
  frame.camera = camera;
  return frame;
}

std::int64_t pairing_tolerance_us(const CameraMode& mode) {
  return std::int64_t{550'000} / mode.rate_hz;
}

std::optional<ImagePair> TimestampPairing::put(SensorImage image) {
  const bool is_depth = image.sensor == SensorImage::Sensor::kDepth;
  Queue& own = is_depth ? depth_ : colour_;
  Queue& other = is_depth ? colour_ : depth_;
  if (!own.empty() && image.device_us < own.back().device_us) give_up_front(own, own.size());
  give_up_older(other, image);
  const auto nearest = std::min_element(other.begin(), other.end(), [&](const SensorImage& a, const SensorImage& b) {
    return distance_us(a, image) < distance_us(b, image);
  });
  if (nearest == other.end() || distance_us(*nearest, image) > tolerance_us_) {
    own.push_back(std::move(image));
    if (own.size() > kMaxUnpaired) give_up_front(own, 1);
    return std::nullopt;
  }
  give_up_front(own, own.size());
  give_up_front(other, static_cast<std::size_t>(nearest - other.begin()));
  SensorImage partner = std::move(other.front());
  other.pop_front();
  if (is_depth) return ImagePair{std::move(image), std::move(partner)};
  return ImagePair{std::move(partner), std::move(image)};
}

void TimestampPairing::clear() {
  give_up_front(depth_, depth_.size());
  give_up_front(colour_, colour_.size());
}

std::int64_t TimestampPairing::distance_us(const SensorImage& a, const SensorImage& b) const {
  return std::abs(static_cast<std::int64_t>(a.device_us) - static_cast<std::int64_t>(b.device_us));
}

void TimestampPairing::give_up_front(Queue& queue, std::size_t count) {
  if (&queue == &depth_) unpaired_ += static_cast<std::int64_t>(count);
  queue.erase(queue.begin(), queue.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Images taken too long before `image` cannot match a later one of that sensor either.
void TimestampPairing::give_up_older(Queue& queue, const SensorImage& image) {
  std::size_t count = 0;
  while (count < queue.size() && queue[count].device_us < image.device_us &&
         distance_us(queue[count], image) > tolerance_us_) {
    ++count;
  }
  give_up_front(queue, count);
}

}  // namespace houghstream::openni
