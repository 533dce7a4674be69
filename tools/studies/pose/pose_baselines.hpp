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

namespace houghstream {

// Shares are of the model's diameter, that of the sphere about its box's centre.
//
// The defaults were chosen on the three development scenes of hs-render (20 frames each, 106 objects in every second,
// 41 in every fifth), with detections made of the truth: the visible box moved by 5 % of its size, the centre by 12 mm
// along each axis (standard deviations). Right poses (ADD-S below 10 % of the diameter) of objects at least 40 %
// visible, and the median CPU time of one.
// FPFH, 106 objects: as below 100, 0.78 s | inlier share falling from 0.4 to 0.1 over the runs: 91, 0.53 s
// FPFH, 41 objects: as below 39 | 6 runs: 36 | 2 runs of 30000 iterations, 5 or 20 similar features: 24
//   inlier share 0.2, 20 runs of 5000: 37 | 6 runs, feature radius 0.15: 34
//   4 runs, inlier share 0.2, 5 similar features: feature radius 0.3: 27; spacing 0.04: 30, with share 0.1: 33
//   inlier share 0.4 to 0.1: 40 runs: 37; 12 runs: 38; 20 similar features: 38; 5: 36; normal radius 0.02 m: 35;
//   spacing 0.07, inlier distance 0.045: 38
// PPF, 106 objects: as below 106, 0.09 s | 1 level of ICP: 106, 0.09 s | spacing and step 0.1, share 0.2: 106, 0.07 s
// PPF, 41 objects, reference share 0.2: 40 | step 0.05: 41, several times the training | 10 poses: 41
//   reference share 0.5: 41, twice the time | spacing and step 0.05: over a minute of training a model

/// Settings of a region's point cloud.
struct SurfaceSettings {
  double spacing_m = 0.004;        ///< distance between the points that are kept
  double normal_radius_m = 0.015;  ///< radius of the neighbours whose plane gives a measured normal
  int measured_points = 8000;      ///< approximate number in a region before thinning
};

/// Settings of FPFH, pcl::SampleConsensusPrerejective and ICP.
struct PrerejectiveSettings {
  SurfaceSettings surface;
  double spacing = 0.06;          ///< spacing of the points of model and region, a fraction
  double feature_radius = 0.2;    ///< radius of a histogram's neighbours, a fraction
  int runs = 20;                  ///< each with its own draw and its own ICP
  int iterations = 10000;         ///< samples of a run
  int samples = 3;                ///< pairs that make a pose
  int similar_features = 10;      ///< a sample's partner is drawn among so many
  float similarity = 0.9F;        ///< minimum similarity of the samples' mutual distances, 0 to 1
  float inlier_fraction = 0.1F;   ///< fraction of the model's points; of poses with so many, PCL takes the best fit
  double inlier_distance = 0.04;  ///< an inlier has a measured point so near, a share
  int icp_iterations = 30;        ///< maximum at each of two distances
  int icp_points = 400;           ///< approximate number in the region
  double icp_start_m = 0.02;      ///< pairs farther apart do not count
  double icp_end_m = 0.01;
};

/// Settings of cv::ppf_match_3d.
struct PpfSettings {
  SurfaceSettings surface;
  double spacing = 0.08;            ///< spacing of the points of model and region, a fraction
  double distance_step = 0.08;      ///< step of the model's table, a fraction
  int angles = 30;                  ///< steps in a full turn
  double reference_fraction = 0.1;  ///< fraction of the region's points that vote
  double cluster_m = 0.01;          ///< poses nearer than both limits are one
  double cluster_rad = 0.2;
  int kept = 5;  ///< poses that ICP refines
  int icp_iterations = 100;
  float icp_tolerance = 0.005F;  ///< relative change of the residual that ends a level
  float icp_rejection = 2.5F;    ///< pairs farther apart than so many standard deviations do not count
  int icp_levels = 4;            ///< levels of the pyramid, each with half as many points
};

/// Estimates poses by other libraries, as baselines of PoseEstimator with the same detections. They use depth only, of
/// the same pixels: those with depth inside find_region(). Of several poses the one with the best depth score
/// (score_pose()) is returned, as in PoseEstimator.
class BaselineEstimator {
 public:
  virtual ~BaselineEstimator() = default;

  /// Returns T_camera_object of the detection, metres; uses its class, box and centre, not its votes. Returns nothing
  /// where the class has no model, the centre is unknown, the region holds too few points, or no pose was found whose
  /// ObjectModel::vote_centre is within RegistrationSettings::max_shift_m of the centre. The same input gives the same
  /// bits. Throws InputError for an invalid frame.
  virtual std::optional<Eigen::Isometry3d> estimate(const RgbdFrame& frame, const Detection& detection) const = 0;
};

/// Makes the baseline of PCL: fast point feature histograms (Rusu, Blodow, Beetz 2009) of model and region are matched
/// by random sampling that rejects samples early whose distances disagree (Buch et al. 2013,
/// pcl::SampleConsensusPrerejective), then point-to-plane ICP (register_points_pcl()). Models by class name, metres.
/// Throws InputError for settings out of range and for models as make_object_model() does. PCL draws from std::rand(),
/// which each estimate seeds again: one estimate runs at a time, and nothing else may draw while it does.
std::unique_ptr<BaselineEstimator> make_prerejective_baseline(const std::map<std::string, Mesh>& models,
                                                              const PoseSettings& pose,
                                                              const PrerejectiveSettings& settings);

/// Makes the baseline of OpenCV: votes of point pairs (Drost et al. 2010, cv::ppf_match_3d::PPF3DDetector), then
/// cv::ppf_match_3d::ICP of the best few poses. Models by class name, metres; throws as make_prerejective_baseline()
/// does.
std::unique_ptr<BaselineEstimator> make_ppf_baseline(const std::map<std::string, Mesh>& models,
                                                     const PoseSettings& pose, const PpfSettings& settings);

}  // namespace houghstream
