#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::world {

/// Describes where a body touches the level plane below it. Plane coordinates have their origin below the centre of
/// mass.
struct Support {
  std::vector<Eigen::Vector2d> corners;               ///< convex, counter-clockwise seen from above; metres
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();   ///< the plane's axes, unit length, object frame
  Eigen::Vector3d across = Eigen::Vector3d::UnitY();  ///< along x across = -down
  double height_m = 0.0;                              ///< height of the centre of mass over the plane

  /// Returns the distance from the centre of mass's foot to the nearest border, metres; it is negative where the foot
  /// lies outside: the body falls.
  double margin_m() const;
  Eigen::Vector3d in_object(const Eigen::Vector2d& direction) const {
    return direction.x() * along + direction.y() * across;
  }
};

/// A solid of even density that tips over its edges on a level plane, without momentum, until it rests.
class TippingBody {
 public:
  /// The mesh must enclose a volume; throws InputError otherwise.
  explicit TippingBody(const Mesh& mesh);

  const Eigen::Vector3d& centre_of_mass() const { return centre_of_mass_; }  ///< object frame, metres

  /// Returns the vertices that touch the plane, or are within `nearly_m` of it, when `down` (unit length, object frame)
  /// points at it.
  Support support(const Eigen::Vector3d& down, double nearly_m = 0.0) const;

  /// Returns the direction that points down when the body, released with `down` below, has come to rest. Round objects
  /// are made of flat strips: it rolls on over edges that raise it by less than a fraction of a millimetre, as long as
  /// that leads down.
  Eigen::Vector3d settled(Eigen::Vector3d down) const;

 private:
  Eigen::Vector3d fallen(Eigen::Vector3d down) const;
  Eigen::Vector3d tipped(const Eigen::Vector3d& down, const Support& support, const Eigen::Vector2d& pivot,
                         const Eigen::Vector2d& towards) const;
  std::optional<Eigen::Vector3d> rolled(const Eigen::Vector3d& down, const Support& support) const;

  Eigen::Vector3d centre_of_mass_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> points_;  ///< relative to the centre of mass, metres
};

}  // namespace houghstream::world
