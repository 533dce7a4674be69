#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace houghstream::studies {

/// Gives the pose of an object of a sequence at a time.
struct TrueInstance {
  int instance = 0;  ///< 1 or more
  std::string class_name;
  std::optional<Eigen::Isometry3d> T_world_object;  ///< nothing after it has been taken away
  double visible = 0.0;                             ///< share that the camera sees which sees most of it
};

struct SequenceCamera {
  std::filesystem::path scene;  ///< BOP folder
  std::string channel;
  std::vector<Eigen::Isometry3d> T_world_camera;  ///< per frame
};

/// File of a sequence by `hs-render sequences` (tools/render/sequence_jobs.hpp).
struct SequenceFile {
  std::string name;
  double fps = 30.0;
  std::vector<SequenceCamera> cameras;
  std::vector<std::int64_t> utimes;
  std::vector<std::vector<TrueInstance>> frames;  ///< ground truth by frame and instance

  std::optional<std::size_t> index_of(std::int64_t utime) const;
};

/// The sequence as a camera of a lower rate would have seen it: of `every` frames one.
SequenceFile thinned(const SequenceFile& sequence, std::size_t every);

/// Reads FOLDER/sequence.json. Throws InputError naming file and entry.
SequenceFile read_sequence(const std::filesystem::path& folder);

/// Writes a sequence as the cameras and whoever knows their places would have sent it: each frame on its camera's
/// channel, and before it the transform <CAMERA>_TO_WORLD. `wrong_m` is added to the places of cameras by channel, to
/// see whether it is noticed. Of `every` frames one is written.
void write_sequence_log(const SequenceFile& sequence, const std::filesystem::path& log,
                        const std::map<std::string, Eigen::Vector3d>& wrong_m, std::size_t every = 1);

/// Joins a log of frames with the results of other logs behind each frame (same name): first those of the first log.
/// Throws InputError where a log cannot be read or written.
void join_logs(const std::filesystem::path& frames, const std::vector<std::filesystem::path>& results,
               const std::filesystem::path& out);

}  // namespace houghstream::studies
