#include "pose/tracks/camera_extrinsics.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/printable.hpp"
#include "pipeline/base/yaml_text.hpp"
#include "pipeline/types/frame_id.hpp"
#include "pose/motion/twist.hpp"

namespace houghstream::tracks {
namespace {

constexpr std::size_t kMaxSamples = 2048;

bool are_equal_poses(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kMaxDifference = 1e-6;
  return local_coordinates_about_world(a, b).cwiseAbs().maxCoeff() < kMaxDifference;
}

Eigen::Isometry3d make_rigid_transform(const Eigen::Vector3d& translation, const Eigen::Vector4d& wxyz,
                                       const std::string& source) {
  constexpr double kUnitTolerance = 1e-2;  // written by people, with a few digits
  constexpr double kMaxDistanceM = 1e6;
  require(translation.allFinite() && translation.cwiseAbs().maxCoeff() <= kMaxDistanceM,
          "{}: translation ({}, {}, {}), expected metres within {}", source, translation.x(), translation.y(),
          translation.z(), kMaxDistanceM);
  require(std::abs(wxyz.norm() - 1.0) < kUnitTolerance, "{}: quaternion of length {:.3f}, expected 1", source,
          wxyz.norm());
  return Eigen::Translation3d(translation) * Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
}

/// Gives the pose of a camera, or of another frame, in its parent.
struct ParentTransform {
  std::string parent;
  Eigen::Isometry3d T_parent_child = Eigen::Isometry3d::Identity();
};
using ParentTransforms = std::map<std::string, ParentTransform>;

template <int Count>
Eigen::Matrix<double, Count, 1> read_numbers(const YAML::Node& node, const std::string& source) {
  Eigen::Matrix<double, Count, 1> out;
  require(node.IsDefined() && node.IsSequence() && node.size() == Count, "{}: expected {} numbers", source, Count);
  for (int i = 0; i < Count; ++i) {
    const std::optional<double> number = yaml_number(node[i]);
    require(number.has_value(), "{}: expected {} numbers", source, Count);
    out[i] = *number;
  }
  return out;
}

double read_number(const YAML::Node& node, const char* key, const std::string& source) {
  const std::optional<double> number = yaml_number(yaml_member(node, key));
  require(number.has_value(), "{}: no number {}", source, key);
  return *number;
}

/// Throws InputError for a name that is not `known`: an entry under a damaged or duplicate name would be ignored
/// silently.
void require_names(const YAML::Node& map, const std::set<std::string>& known, const std::string& source) {
  for (const std::string& name : yaml_names(map, source))
    require(known.count(name) > 0, "{}: '{}', expected one of {}", source, printable(name), fmt::join(known, ", "));
}

void add_cameras(const YAML::Node& cameras, const std::string& file, ParentTransforms& parents) {
  for (const auto& entry : cameras) {
    require(entry.first.IsScalar(), "{}: a camera whose name is no text", file);
    const std::string& name = entry.first.Scalar();
    const YAML::Node& node = entry.second;
    const std::string source = fmt::format("{}: camera {}", file, printable(name));
    require(parents.count(name) == 0, "{}: duplicate camera {}", file, printable(name));
    require(node.IsMap(), "{}: expected translation and rotation", source);
    const YAML::Node parent = yaml_member(node, "parent");
    parents[name] = {
        parent.IsDefined() && parent.IsScalar() ? parent.Scalar() : "world",
        make_rigid_transform(read_numbers<3>(yaml_member(node, "translation"), source + ": translation"),
                             read_numbers<4>(yaml_member(node, "rotation"), source + ": rotation"), source)};
    require_names(node, {"parent", "translation", "rotation"}, source);
  }
}

void add_transforms(const YAML::Node& transforms, const std::string& file, ParentTransforms& parents) {
  for (const auto& node : transforms) {
    const YAML::Node child = yaml_member(node, "child_frame_id");
    const YAML::Node parent = yaml_member(yaml_member(node, "header"), "frame_id");
    require(child.IsDefined() && child.IsScalar() && parent.IsDefined() && parent.IsScalar(),
            "{}: a transform without header.frame_id and child_frame_id", file);
    const std::string source = fmt::format("{}: frame {}", file, printable(child.Scalar()));
    const YAML::Node t = yaml_member(yaml_member(node, "transform"), "translation");
    const YAML::Node q = yaml_member(yaml_member(node, "transform"), "rotation");
    parents[child.Scalar()] = {
        parent.Scalar(),
        make_rigid_transform({read_number(t, "x", source), read_number(t, "y", source), read_number(t, "z", source)},
                             {read_number(q, "w", source), read_number(q, "x", source), read_number(q, "y", source),
                              read_number(q, "z", source)},
                             source)};
  }
}

ParentTransforms read_parent_transforms(const YAML::Node& yaml, const std::string& file) {
  ParentTransforms parents;
  const YAML::Node cameras = yaml_member(yaml, "cameras");
  const YAML::Node transforms = yaml_member(yaml, "transforms");
  // Entries of a list have no name.
  require((!cameras.IsDefined() || cameras.IsMap()) && (!transforms.IsDefined() || transforms.IsSequence()),
          "{}: expected 'cameras:' with names, or a list of 'transforms:'", file);
  if (cameras.IsDefined()) add_cameras(cameras, file, parents);
  if (transforms.IsDefined()) add_transforms(transforms, file, parents);
  if (!parents.empty()) require_names(yaml, {"cameras", "transforms"}, file);
  return parents;
}

Eigen::Isometry3d chain_to_root(const ParentTransforms& parents, const std::string& camera, const std::string& file) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  std::set<std::string> visited;
  for (auto child = parents.find(camera); child != parents.end(); child = parents.find(child->second.parent)) {
    require(visited.insert(child->first).second, "{}: camera {}: its parents go round in a loop through {}", file,
            camera, child->first);
    T = child->second.T_parent_child * T;
  }
  return T;
}

}  // namespace

void CameraExtrinsics::set_static(const std::string& camera, const Eigen::Isometry3d& T_world_camera) {
  static_[camera] = T_world_camera;
}

void CameraExtrinsics::add_transform(const std::string& camera, std::int64_t utime,
                                     const Eigen::Isometry3d& T_world_camera) {
  require(moving_.size() < kMaxMoving || moving_.count(camera) > 0,
          "transforms of more than {} cameras, expected at most that many", kMaxMoving);
  std::deque<Sample>& samples = moving_[camera];
  if (!samples.empty() && seconds_between(utime, samples.back().utime) > 1.0) samples.clear();
  auto position = samples.end();
  while (position != samples.begin() && (position - 1)->utime >= utime) --position;
  if (position != samples.end() && position->utime == utime) {
    position->T_world_camera = T_world_camera;
  } else {
    samples.insert(position, {utime, T_world_camera});
  }
  if (samples.size() > kMaxSamples) samples.pop_front();
}

CameraPose CameraExtrinsics::interpolate(const std::string& camera, std::int64_t utime) const {
  const auto seconds = [&](std::int64_t other) { return seconds_between(utime, other); };
  if (const auto fixed = static_.find(camera); fixed != static_.end()) return {fixed->second, false, ""};
  const auto moving = moving_.find(camera);
  if (moving == moving_.end()) return {std::nullopt, true, fmt::format("no transform of {} has come", camera)};
  const std::deque<Sample>& samples = moving->second;
  const auto after = std::lower_bound(samples.begin(), samples.end(), utime,
                                      [](const Sample& sample, std::int64_t time) { return sample.utime < time; });
  if (after == samples.end()) {
    const std::size_t count = samples.size();
    if (count >= 2 && are_equal_poses(samples[count - 1].T_world_camera, samples[count - 2].T_world_camera))
      return {samples.back().T_world_camera, false, ""};
    return {std::nullopt, true,
            fmt::format("the last transform of {} is {:.3f} s older", camera, -seconds(samples.back().utime))};
  }
  if (after->utime == utime) return {after->T_world_camera, false, ""};
  if (after == samples.begin())
    return {std::nullopt, false,
            fmt::format("the first transform of {} is {:.3f} s later: do the clocks agree?", camera,
                        seconds(after->utime))};
  const Sample& before = *(after - 1);
  const double gap = seconds_between(before.utime, after->utime);
  if (gap > kMaxGapS && !are_equal_poses(before.T_world_camera, after->T_world_camera))
    return {
        std::nullopt, false,
        fmt::format("the transforms of {} about it are {:.3f} s apart, expected at most {} s", camera, gap, kMaxGapS)};
  return {interpolate_pose(before.T_world_camera, after->T_world_camera, -seconds(before.utime) / gap), false, ""};
}

std::map<std::string, Eigen::Isometry3d> read_camera_extrinsics(const std::filesystem::path& file) {
  constexpr std::size_t kMaxFrames = 1024;  // each may hang on all others
  const ParentTransforms parents =
      read_parent_transforms(parse_yaml(read_file(file, "a YAML file of camera poses"), file.string()), file.string());
  require(!parents.empty(), "{}: neither 'cameras:' nor 'transforms:', expected poses of cameras", file.string());
  require(parents.size() <= kMaxFrames, "{}: poses of {} frames, expected at most {}", file.string(), parents.size(),
          kMaxFrames);
  std::map<std::string, Eigen::Isometry3d> poses;
  for (const auto& [camera, transform] : parents) poses[camera] = chain_to_root(parents, camera, file.string());
  return poses;
}

std::pair<std::string, Eigen::Isometry3d> parse_camera_pose(const std::string& text) {
  const std::string expected = "CHANNEL=x,y,z,qw,qx,qy,qz";
  const std::size_t equals = text.find('=');
  require(equals != std::string::npos && equals > 0, "--camera-pose '{}', expected {}", printable(text), expected);
  std::vector<double> numbers;
  std::istringstream rest(text.substr(equals + 1));
  for (std::string word; std::getline(rest, word, ',');) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    require(!word.empty() && end == word.c_str() + word.size(), "--camera-pose '{}': '{}' is no number, expected {}",
            printable(text), printable(word), expected);
  }
  require(numbers.size() == 7, "--camera-pose '{}': {} numbers, expected {}", printable(text), numbers.size(),
          expected);
  return {text.substr(0, equals),
          make_rigid_transform({numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5], numbers[6]},
                               "--camera-pose " + printable(text))};
}

void add_camera_pose(const std::string& text, std::map<std::string, Eigen::Isometry3d>& poses) {
  const auto [camera, T_world_camera] = parse_camera_pose(text);
  require(poses.emplace(camera, T_world_camera).second,
          "--camera-pose '{}': {} has a place already, of --cameras or of another --camera-pose", text, camera);
}

}  // namespace houghstream::tracks
