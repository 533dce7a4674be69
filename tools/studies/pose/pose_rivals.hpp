#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pose/pose_settings.hpp"
#include "tools/studies/pose/rival_settings.hpp"

namespace houghstream {

/// What others' libraries offer in place of our PoseEstimator, given the same detections. They look at depth only, and
/// at what ours looks at: the pixels with depth inside find_region(). Of several poses the one is given for which the
/// depth speaks most (score_pose()), as among ours.
class BaselineEstimator {
 public:
  virtual ~BaselineEstimator() = default;

  /// T_camera_object of the detection, metres; uses its class, box and centre, not its votes. Nothing where the class
  /// has no model, the centre is unknown, the region holds too few points, or no pose was found whose
  /// ObjectModel::vote_centre is within RegistrationSettings::max_shift_m of the centre. The same input gives the same
  /// bits. Throws InputError for a frame that is none.
  virtual std::optional<Eigen::Isometry3d> estimate(const RgbdFrame& frame, const Detection& detection) const = 0;
};

/// PCL: fast point feature histograms (Rusu, Blodow, Beetz 2009) of model and region are brought together by random
/// sampling that gives up early on samples whose distances disagree (Buch et al. 2013,
/// pcl::SampleConsensusPrerejective), then point-to-plane ICP (register_points_pcl()). Models by class name, metres.
/// Throws InputError for settings out of range and for models as make_object_model() does. PCL draws from std::rand(),
/// which each estimate seeds anew: one estimate runs at a time, and nothing else may draw while it does.
std::unique_ptr<BaselineEstimator> make_prerejective_rival(const std::map<std::string, Mesh>& models,
                                                           const PoseSettings& pose,
                                                           const PrerejectiveSettings& settings);

/// OpenCV: votes of point pairs (Drost et al. 2010, cv::ppf_match_3d::PPF3DDetector), then
/// cv::ppf_match_3d::ICP of the best few poses. Models by class name, metres; throws as the other.
std::unique_ptr<BaselineEstimator> make_ppf_rival(const std::map<std::string, Mesh>& models, const PoseSettings& pose,
                                                  const PpfSettings& settings);

}  // namespace houghstream
