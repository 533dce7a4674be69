#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <vector>

namespace houghstream {

/// Parses the map of names and values of a YAML file as people, OpenCV and ROS write it: without a header or with
/// OpenCV's (%YAML:1.0), and with lines of ---, by which ROS' tools end a message. Throws InputError, which names
/// `source`, for text that is no YAML, no such map or larger than a MiB, and for a duplicate name in it.
YAML::Node parse_yaml(const std::string& text, const std::string& source);

/// Returns the names of the map, in their order. Throws InputError, which names `of`, where one is no text or a
/// duplicate: yaml-cpp keeps both, and returns the first.
std::vector<std::string> yaml_names(const YAML::Node& map, const std::string& of);

/// Returns the node in `map` under the name; an undefined node where there is none, or `map` is no map.
YAML::Node yaml_member(const YAML::Node& map, const std::string& name);

/// Returns nothing where the node is no number.
std::optional<double> yaml_number(const YAML::Node& node);

}  // namespace houghstream
