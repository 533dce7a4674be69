#pragma once

namespace houghstream {

// Shares are of the model's diameter, that of the sphere about its box's centre.

/// How a point cloud is made of a region.
struct SurfaceSettings {
  double spacing_m = 0.004;        ///< of the points that are kept
  double normal_radius_m = 0.015;  ///< of the neighbours whose plane gives a measured normal
  int measured_points = 8000;      ///< of a region, about, before thinning
};

/// FPFH, pcl::SampleConsensusPrerejective, ICP.
struct PrerejectiveSettings {
  SurfaceSettings surface;
  double spacing = 0.06;        ///< of the points of model and region, a share
  double feature_radius = 0.2;  ///< of a histogram's neighbours, a share
  int runs = 20;                ///< each with its own draw and its own ICP
  int iterations = 5000;        ///< of a run
  int samples = 3;              ///< pairs that make a pose
  int similar_features = 10;    ///< a sample's partner is drawn among so many
  float similarity = 0.9F;      ///< of the samples' mutual distances, 0 to 1
  /// Of the model's points, what must be inliers in the first and in the last run. Of the poses with so many, PCL takes
  /// the one whose inliers fit best, which with too small a share touches the scene at an edge; too large a share finds
  /// nothing where much is hidden, and the far side always is.
  float most_inliers = 0.4F;
  float least_inliers = 0.1F;
  double inlier_distance = 0.04;  ///< an inlier has a measured point so near, a share
  int icp_iterations = 30;        ///< at each of two distances
  int icp_points = 400;           ///< of the region, about
  double icp_start_m = 0.02;      ///< pairs farther apart do not count
  double icp_end_m = 0.01;
};

/// cv::ppf_match_3d.
struct PpfSettings {
  SurfaceSettings surface;
  double spacing = 0.08;         ///< of the points of model and region, a share
  double distance_step = 0.08;   ///< of the model's table, a share
  int angles = 30;               ///< steps in a full turn
  double reference_share = 0.1;  ///< of the region's points that vote
  double cluster_m = 0.01;       ///< poses nearer than both limits are one
  double cluster_rad = 0.2;
  int kept = 5;  ///< poses that ICP refines
  int icp_iterations = 100;
  float icp_tolerance = 0.005F;  ///< relative change of the residual that ends a level
  float icp_rejection = 2.5F;    ///< pairs farther apart than so many standard deviations do not count
  int icp_levels = 4;            ///< of the pyramid, each of half as many points
};

}  // namespace houghstream
