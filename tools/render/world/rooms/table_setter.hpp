#pragma once

#include "tools/render/world/rooms/held.hpp"
#include "tools/render/world/rooms/put_down.hpp"
#include "tools/render/world/rooms/table_layout.hpp"

namespace houghstream::world {

/// Puts things on a world's table, where there is room for them.
class TableSetter {
 public:
  /// `table_half`: half the extent of the surface, metres. Keeps a reference to `world`.
  TableSetter(World& world, const Eigen::Vector2d& table_half, std::uint64_t seed)
      : world_(world), half_(table_half.cwiseMin(Eigen::Vector2d(0.62, 0.5))), layout_(table_half), random_(seed) {}

  /// Upright, turned by up to `turn_rad` either way. Whether there was room.
  bool stand(const ThingPtr& thing, const Eigen::AlignedBox2d& region, double turn_rad, int object_id);

  /// Turned any way. Whether there was room.
  bool put(const Group& group, const Eigen::AlignedBox2d& region);

  /// A taught object, named in the truth unless it is a look-alike (ids 5 to 8). Throws InputError without room.
  void stand_object(int id, const Eigen::AlignedBox2d& where);
  void lay_object(int id, const Eigen::AlignedBox2d& where);
  void tilt_object(int id, const Eigen::AlignedBox2d& where);
  void lean_object(int id, const Eigen::AlignedBox2d& where);

  /// A taught object in a hand; nothing else comes below the object or the arm.
  void hold_object(int id, const HeldPlace& place);

  /// Part of the surface, in shares of its half extent.
  Eigen::AlignedBox2d region(double x_low, double x_high, double y_low, double y_high) const {
    return {Eigen::Vector2d(x_low * half_.x(), y_low * half_.y()),
            Eigen::Vector2d(x_high * half_.x(), y_high * half_.y())};
  }

  Random& random() { return random_; }

 private:
  World& world_;
  Eigen::Vector2d half_;
  TableLayout layout_;
  Random random_;
};

}  // namespace houghstream::world
