#pragma once

namespace houghstream {

/// How a point cloud is made of a region and of a model.
struct SurfaceSettings {
  double spacing_m = 0.005;        ///< of the points that are kept
  double normal_radius_m = 0.015;  ///< of the neighbours whose plane gives a measured normal
  int measured_points = 8000;      ///< of a region, about, before thinning
};

/// FPFH, pcl::SampleConsensusPrerejective, ICP.
struct PrerejectiveSettings {
  SurfaceSettings surface;
  double feature_radius_m = 0.03;
  int runs = 4;               ///< each with its own draw and its own ICP
  int iterations = 10000;     ///< of a run
  int samples = 3;            ///< pairs that make a pose
  int similar_features = 5;   ///< a sample's partner is drawn among so many
  float similarity = 0.9F;    ///< of the samples' mutual distances, 0 to 1
  float inlier_share = 0.2F;  ///< of the model's points; the far side is never seen
  double inlier_m = 0.0075;   ///< an inlier has a measured point so near
  int icp_iterations = 30;    ///< at each of two distances
  int icp_points = 400;
  double icp_start_m = 0.02;  ///< pairs farther apart do not count
  double icp_end_m = 0.01;
};

/// cv::ppf_match_3d. Its steps are shares of the extent of the model's cloud.
struct PpfSettings {
  SurfaceSettings surface;
  double model_step = 0.05;      ///< sampling of the model, and step of the distances in its table
  int angles = 30;               ///< steps in a full turn
  double scene_step = 0.03;      ///< sampling of the region, a share of its own extent
  double reference_share = 0.2;  ///< of the region's points that vote
  double cluster_m = 0.01;       ///< poses nearer than both limits are one
  double cluster_rad = 0.2;
  int kept = 5;  ///< poses that ICP refines
  int icp_iterations = 100;
  float icp_tolerance = 0.005F;  ///< relative change of the residual that ends a level
  float icp_rejection = 2.5F;    ///< pairs farther apart than so many standard deviations do not count
  int icp_levels = 4;            ///< of the pyramid, each of half as many points
};

}  // namespace houghstream
