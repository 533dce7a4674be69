#pragma once

#include <memory>
#include <string>

#include "drivers/frame_source.hpp"

namespace houghstream::ros_bag {

/// Opens the frames of a ROS 1 bag: "FILE", or "FILE,depth=TOPIC,colour=TOPIC,info=TOPIC" where the topics are not
/// those that choose_topics() finds; "camera=WIDTHxHEIGHT,fx,fy,cx,cy" takes the place of a camera_info. A frame is a
/// depth image with the colour image whose header stamp is nearest, at most half the time between two depth images
/// away, and has the depth's stamp; frames come in the order of stamps. Images without a partner are counted, and
/// logged with the last frame. Depth is taken as registered to colour; where frame_ids and names do not say so, a
/// warning is logged. Messages are read as their turn comes. Throws InputError naming file and topic where the bag
/// cannot be read, topics or intrinsics are missing or not unique, images have other sizes than their camera, or
/// nothing can be paired.
std::unique_ptr<FrameSource> open_bag_source(const std::string& value);

}  // namespace houghstream::ros_bag
