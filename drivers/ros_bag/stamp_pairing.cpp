#include "drivers/ros_bag/stamp_pairing.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace houghstream::ros_bag {
namespace {

constexpr std::ptrdiff_t kAhead = 3;  // later images of either kind that are waited for
constexpr std::size_t kMaxImages = 512;
constexpr std::size_t kMaxBytes = std::size_t{256} << 20U;

bool is_earlier(std::int64_t stamp_us, const StampedImage& image) {
  return stamp_us < image.stamp_us;
}

}  // namespace

void StampPairing::add_depth(StampedImage image) {
  const bool is_there = std::any_of(depth_.rbegin(), depth_.rend(),
                                    [&](const StampedImage& other) { return other.stamp_us == image.stamp_us; });
  if (is_there || image.stamp_us == last_us_) {
    ++unpaired_.repeated;
  } else if (image.stamp_us < last_us_) {
    ++unpaired_.depth;
  } else {
    insert(depth_, std::move(image));
  }
}

void StampPairing::add_colour(StampedImage image) {
  insert(colour_, std::move(image));
}

void StampPairing::insert(Queue& queue, StampedImage image) {
  waiting_bytes_ += image.message.bytes.size();
  queue.insert(std::upper_bound(queue.begin(), queue.end(), image.stamp_us, is_earlier), std::move(image));
}

StampedImage StampPairing::take_front(Queue& queue) {
  StampedImage image = std::move(queue.front());
  queue.pop_front();
  waiting_bytes_ -= image.message.bytes.size();
  return image;
}

bool StampPairing::is_settled(std::int64_t stamp_us) const {
  const auto later = [&](const Queue& queue) {
    return queue.end() - std::upper_bound(queue.begin(), queue.end(), stamp_us + tolerance_us_, is_earlier);
  };
  return is_ended_ || (later(depth_) >= kAhead && later(colour_) >= kAhead) || is_full();
}

bool StampPairing::is_full() const {
  return depth_.size() + colour_.size() > kMaxImages || waiting_bytes_ > kMaxBytes;
}

StampPairing::Queue::iterator StampPairing::nearest_colour(std::int64_t stamp_us) {
  const auto nearest = std::min_element(colour_.begin(), colour_.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.stamp_us - stamp_us) < std::abs(b.stamp_us - stamp_us);
  });
  const bool is_near = nearest != colour_.end() && std::abs(nearest->stamp_us - stamp_us) <= tolerance_us_;
  return is_near ? nearest : colour_.end();
}

std::optional<StampedPair> StampPairing::pop() {
  while (!depth_.empty() && is_settled(depth_.front().stamp_us)) {
    const std::int64_t stamp_us = depth_.front().stamp_us;
    while (!colour_.empty() && colour_.front().stamp_us < stamp_us - tolerance_us_) {
      take_front(colour_);
      ++unpaired_.colour;
    }
    const auto colour = nearest_colour(stamp_us);
    const bool next_is_nearer = colour != colour_.end() && depth_.size() > 1 &&
                                std::abs(depth_[1].stamp_us - colour->stamp_us) < std::abs(stamp_us - colour->stamp_us);
    StampedImage depth = take_front(depth_);
    if (colour == colour_.end() || next_is_nearer) {
      ++unpaired_.depth;
      continue;
    }
    for (auto before = colour - colour_.begin(); before > 0; --before) {
      take_front(colour_);
      ++unpaired_.colour;
    }
    last_us_ = stamp_us;
    return StampedPair{std::move(depth), take_front(colour_)};
  }
  while (depth_.empty() && !colour_.empty() && (is_ended_ || is_full())) {
    take_front(colour_);
    ++unpaired_.colour;
  }
  return std::nullopt;
}

}  // namespace houghstream::ros_bag
