#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "drivers/ros_bag/bag_file.hpp"

namespace houghstream::ros_bag {

/// Names the topics that a user wants; "" = found by itself.
struct WantedTopics {
  std::string depth;
  std::string colour;
  std::string info;  ///< the colour camera's intrinsics
};

/// Describes a topic whose messages are read.
struct ChosenTopic {
  std::string name;
  std::string type;
  std::set<std::uint32_t> connections;  ///< those of all its publishers
  std::string frame_id;                 ///< of its first message
};

struct ChosenTopics {
  ChosenTopic depth;
  ChosenTopic colour;
  ChosenTopic info;  ///< without a name where the bag has none
};

/// Finds depth, colour and intrinsics. Depth and colour are told by the encoding of each image topic's first message;
/// of several depth topics those that are called depth count, of these the ones called registered or aligned, of colour
/// topics those of the depth's camera; infrared images do not count. Of the same camera's images a rectified topic
/// comes before a raw one, and an uncompressed one before its compressed copy. The intrinsics are the topic camera_info
/// beside colour, else beside depth. Throws InputError naming the topics where there is none, or several cameras.
ChosenTopics choose_topics(BagFile& file, const WantedTopics& wanted);

/// Returns whether a topic's images are rectified, by its name, as the package image_proc gives it: image_rect_color.
bool is_rectified(const std::string& topic);

/// Returns whether depth is registered to colour, by frame_ids and names.
bool is_registered(const ChosenTopics& topics);

}  // namespace houghstream::ros_bag
