#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "drivers/frame_source.hpp"

namespace houghstream {

/// Opens "bop:DIR" (a BOP scene folder), "uw:DIR" (a UW RGB-D scene folder: NAME_color.png or NAME.png with
/// NAME_depth.png, at the dataset's 640x480 with the nominal camera 525,525,319.5,239.5, or as
/// "uw:DIR,WIDTHxHEIGHT,fx,fy,cx,cy"), "tum:DIR" (a sequence of the TUM RGB-D benchmark, with the same nominal camera
/// or its own) or "bag:FILE" (a ROS 1 bag, drivers/ros_bag/bag_source.hpp). Throws InputError naming what is known;
/// `others` are those that the caller opens itself, "oni:FILE, ".
std::unique_ptr<FrameSource> open_frame_source(const std::string& specification, const std::string& others = "");

/// Returns "KIND:PLACE", as a folder or a recording that is there wants to be called as a source, and "" where nothing
/// is there or its kind cannot be told.
std::string suggest_source(const std::string& place);

/// Throws InputError where an output is the file or folder of "KIND:WHERE", or of a plain name, or lies in it
/// (require_other_file()).
void require_outside_source(const std::filesystem::path& output, const std::string& specification);

}  // namespace houghstream
