#pragma once

#include <string>

namespace houghstream {

/// YAML as OpenCV reads it, which wants its own header, one document, and the entries of a list indented. People write
/// no header, and ROS' tools end a message with a line of --- and do not indent. Throws InputError, which names
/// `source`, for text that OpenCV's reader would go down into too deep: it takes 5 kB of the stack for each level. A
/// level takes a bracket, or begins further to the right than the one above it, so that brackets and the length of
/// lines are what is limited, and the length of all.
std::string yaml_for_opencv(const std::string& text, const std::string& source);

}  // namespace houghstream
