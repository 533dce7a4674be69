#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace houghstream::studies {

/// An object of a sequence at a time.
struct TrueInstance {
  int instance = 0;  ///< from 1
  std::string class_name;
  std::optional<Eigen::Isometry3d> T_world_object;  ///< nothing where it has been taken away
  double visible = 0.0;                             ///< share that the camera sees which sees most of it
};

struct SequenceCamera {
  std::filesystem::path scene;  ///< BOP folder
  std::string channel;
  std::vector<Eigen::Isometry3d> T_world_camera;  ///< per frame
};

/// What `hs-render sequences` writes of a sequence (tools/render/sequence_jobs.hpp).
struct SequenceFile {
  std::string name;
  double fps = 30.0;
  std::vector<SequenceCamera> cameras;
  std::vector<std::int64_t> utimes;
  std::vector<std::vector<TrueInstance>> frames;  ///< by frame, by instance

  std::optional<std::size_t> index_of(std::int64_t utime) const;
};

/// Reads FOLDER/sequence.json. Throws InputError naming file and entry.
SequenceFile read_sequence(const std::filesystem::path& folder);

}  // namespace houghstream::studies
