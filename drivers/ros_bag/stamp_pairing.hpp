#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "drivers/ros_bag/bag_file.hpp"

namespace houghstream::ros_bag {

/// Holds an image's message, and when the image was taken.
struct StampedImage {
  std::int64_t stamp_us = 0;  ///< microseconds since the epoch
  BagMessage message;
};

/// Holds a depth image and the colour image nearest to it in time.
struct StampedPair {
  StampedImage depth;
  StampedImage colour;
};

/// Images that came into no pair.
struct UnpairedCounts {
  std::int64_t depth = 0;
  std::int64_t colour = 0;
  std::int64_t repeated = 0;  ///< depth images whose stamp another one has too

  std::int64_t all() const { return depth + colour + repeated; }
};

/// Pairs depth and colour of a recording by their stamps: each depth image with the colour image nearest to it, where
/// that is near enough and no other depth image is nearer to it. Pairs come out in the order of their depths' stamps,
/// which rise. Images may come late and out of order: a pair is made once three later images of either kind are there,
/// so that one wrong stamp harms its own image only, or too many wait. (openni::TimestampPairing answers at once, as
/// a camera's frames must.) Not thread-safe.
class StampPairing {
 public:
  explicit StampPairing(std::int64_t tolerance_us) : tolerance_us_(tolerance_us) {}

  void add_depth(StampedImage image);
  void add_colour(StampedImage image);
  /// Tells that no image will come any more.
  void end() { is_ended_ = true; }

  /// Returns the next pair; nothing where more images are needed, or at the end.
  std::optional<StampedPair> pop();

  const UnpairedCounts& unpaired() const { return unpaired_; }

 private:
  using Queue = std::deque<StampedImage>;

  void insert(Queue& queue, StampedImage image);
  StampedImage take_front(Queue& queue);
  bool is_settled(std::int64_t stamp_us) const;
  bool is_full() const;
  Queue::iterator nearest_colour(std::int64_t stamp_us);

  std::int64_t tolerance_us_;
  Queue depth_;   // in the order of stamps
  Queue colour_;  // in the order of stamps
  std::size_t waiting_bytes_ = 0;
  std::int64_t last_us_ = 0;  // stamp of the last pair's depth
  bool is_ended_ = false;
  UnpairedCounts unpaired_;
};

}  // namespace houghstream::ros_bag
