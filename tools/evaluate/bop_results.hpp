#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/evaluate/metrics/evaluated_frame.hpp"

namespace houghstream {

/// One line of a BOP result file.
struct BopEstimate {
  int scene_id = 0;
  int image_id = 0;
  int object_id = 0;
  double score = 0.0;
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< metres
  double time_s = -1.0;  ///< time for the whole image, the same in all its lines; -1 where it is unknown
};

/// Name of the file that hs-evaluate writes beside its report. bop_toolkit wants it renamed to
/// METHOD_DATASET-SPLIT.csv.
inline constexpr const char* kBopResultsFile = "bop_results.csv";

/// Returns all poses that were published, in the order of the frames; the scene's id is scene_number(). A class of
/// which `names` (of the scene, by object id) and its truth know no id is left out with a warning. The time is the sum
/// of the stages that the poses carry.
std::vector<BopEstimate> bop_estimates(const std::vector<EvaluatedFrame>& frames,
                                       const std::map<int, std::string>& names);

/// Writes and reads scene_id,im_id,obj_id,score,R,t,time below a header of these words: R row by row, t in millimetres,
/// time in seconds (bop_toolkit, docs/bop_challenge_2019.md). Throws InputError where the file cannot be written, and
/// naming file and line where it does not hold that.
void write_bop_results(const std::vector<BopEstimate>& estimates, const std::filesystem::path& file);
std::vector<BopEstimate> read_bop_results(const std::filesystem::path& file);

}  // namespace houghstream
