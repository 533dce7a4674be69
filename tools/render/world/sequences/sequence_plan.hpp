#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace houghstream::world {

/// Gives a position on an asset's way.
struct Stop {
  double at_s = 0.0;                                ///< time of its arrival
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< world x and y, and how high it is over the table, metres
  double angle_rad = 0.0;                           ///< about the vertical
  double arc_m = 0.0;                               ///< height by which it is lifted on the way to it
};

/// Describes one of the objects whose ground truth is written. Where two stops differ, a hand moves it from one to the
/// other.
struct Actor {
  int object_id = 1;  ///< id for make_taught_object(); two actors may be equal
  std::vector<Stop> stops;
};

/// Motion of a sequence's cameras.
enum class CameraWork : std::uint8_t {
  kWalk,       ///< one is carried half round the table
  kStill,      ///< one static camera
  kJerk,       ///< one static camera, which is pushed twice
  kThreeStill  ///< three static cameras, in front and to both sides
};

/// Plans a recording of objects over time.
struct SequencePlan {
  std::string name;
  CameraWork cameras = CameraWork::kStill;
  double seconds = 10.0;
  bool arm_passes = false;  ///< an arm reaches through between camera and objects, and away again
  std::vector<Actor> actors;
};

/// Objects farther from the table's middle than this are not in the world: they have been taken away.
inline constexpr double kAwayM = 1.0;

/// All sequences that `hs-render sequences` makes, in their order: walk, pushed, carried, removed, swapped, cans, arm,
/// jerk, cameras.
std::vector<SequencePlan> sequence_plans();

}  // namespace houghstream::world
