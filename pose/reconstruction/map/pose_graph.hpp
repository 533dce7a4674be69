#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pose/reconstruction/map/frame_alignment.hpp"

namespace houghstream::reconstruction {

/// Gives the relative pose of two keyframes from their registration.
struct PoseEdge {
  int from = 0;                                                 ///< keyframe whose points were registered
  int to = 0;                                                   ///< keyframe to whose image they were registered
  Eigen::Isometry3d T_to_from = Eigen::Isometry3d::Identity();  ///< camera to camera
  Matrix6 information = Matrix6::Identity();                    ///< information of a motion of the world, see Alignment
};

/// Corrects poses in place until the edges agree as well as they can: Gauss-Newton on a pose graph (Grisetti et al., "A
/// tutorial on graph-based SLAM", 2010); edges that contradict the others by more than some millimetres have less
/// weight. Pose 0 stays. Poses that no edge ties to pose 0 stay as well.
void optimise_pose_graph(const std::vector<PoseEdge>& edges, std::vector<Eigen::Isometry3d>& T_camera_world);

/// Returns for each pose the minimum number of edges that lead to it from `start`; -1 where none do.
std::vector<int> graph_distances(int start, int poses, const std::vector<PoseEdge>& edges);

}  // namespace houghstream::reconstruction
