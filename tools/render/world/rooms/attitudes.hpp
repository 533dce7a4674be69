#pragma once

#include <string>
#include <vector>

#include "pipeline/base/random.hpp"
#include "tools/render/world/rooms/stable_poses.hpp"

namespace houghstream::world {

/// Attitude in which an object is placed.
enum class Attitude : std::uint8_t {
  kUpright,  ///< z up
  kTilted,   ///< tilted, as if held or leaning: its lowest point touches
  kLying     ///< at rest on a side or upside down
};

/// Parses "upright", "tilted" or "lying". Throws InputError listing them for another name.
Attitude parse_attitude(const std::string& name);

/// Range of the tilt, degrees.
inline constexpr double kMinTiltDeg = 10.0;
inline constexpr double kMaxTiltDeg = 40.0;

/// The attitudes in which one object is shown.
class AttitudeChoice {
 public:
  /// Works out how the mesh rests. Throws InputError for a mesh without volume, or that rests upright only.
  explicit AttitudeChoice(const Mesh& mesh);

  /// Number of lying poses that are distinguished: one for a family of one, two for a larger one.
  int lying_count() const { return static_cast<int>(turns_.size()); }

  /// Returns the rotation from the object into the table frame (z up). Consecutive indices go through the ways of
  /// lying; the rest follows `random`.
  Eigen::Matrix3d R_table_object(Attitude attitude, int index, Random& random) const;

 private:
  Eigen::Matrix3d lying(int index, Random& random) const;

  std::vector<StablePoseFamily> turns_;  ///< families without upright, in the order in which they are shown
};

/// Returns the height of the object frame's origin over a table that the mesh's lowest point touches, metres.
double height_above_table(const Mesh& mesh, const Eigen::Matrix3d& R_table_object);

}  // namespace houghstream::world
