#include "tools/studies/tracks/sequence_file.hpp"

#include <algorithm>

#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream::studies {
namespace {

Eigen::Isometry3d pose_from(const nlohmann::json& numbers) {
  const auto n = numbers.get<std::vector<double>>();
  require(n.size() == 7, "a pose of {} numbers, expected 7", n.size());
  return Eigen::Translation3d(n[0], n[1], n[2]) * Eigen::Quaterniond(n[3], n[4], n[5], n[6]).normalized();
}

SequenceFile sequence_from(const nlohmann::json& json, const std::filesystem::path& folder) {
  SequenceFile out;
  out.name = json.at("name").get<std::string>();
  out.fps = json.at("fps").get<double>();
  for (const auto& camera : json.at("cameras"))
    out.cameras.push_back(
        {folder / camera.at("scene").get<std::string>(), camera.at("channel").get<std::string>(), {}});
  for (const auto& frame : json.at("frames")) {
    out.utimes.push_back(frame.at("utime").get<std::int64_t>());
    std::vector<TrueInstance> instances;
    for (std::size_t i = 0; i < json.at("objects").size(); ++i) {
      const auto& object = json.at("objects").at(i);
      TrueInstance truth{object.at("instance").get<int>(), object.at("name").get<std::string>(), std::nullopt, 0.0};
      if (const auto& pose = frame.at("objects").at(i); !pose.is_null()) truth.T_world_object = pose_from(pose);
      for (const auto& camera : frame.at("cameras"))
        truth.visible = std::max(truth.visible, camera.at("visible").at(i).get<double>());
      instances.push_back(std::move(truth));
    }
    out.frames.push_back(std::move(instances));
    for (std::size_t c = 0; c < out.cameras.size(); ++c)
      out.cameras[c].T_world_camera.push_back(pose_from(frame.at("cameras").at(c).at("T_world_camera")));
  }
  return out;
}

}  // namespace

std::optional<std::size_t> SequenceFile::index_of(std::int64_t utime) const {
  const auto found = std::lower_bound(utimes.begin(), utimes.end(), utime);
  if (found == utimes.end() || *found != utime) return std::nullopt;
  return static_cast<std::size_t>(found - utimes.begin());
}

SequenceFile read_sequence(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "sequence.json";
  const nlohmann::json json = read_json_object(file);
  try {
    return sequence_from(json, folder);
  } catch (const nlohmann::json::exception& error) {
    fail("{}: {}, expected what hs-render sequences writes", file.string(), error.what());
  } catch (const InputError& error) {
    fail("{}: {}", file.string(), error.what());
  }
}

}  // namespace houghstream::studies
