#pragma once

#include <optional>
#include <vector>

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/world.hpp"
#include "tools/render/world/rooms/held.hpp"
#include "tools/render/world/rooms/put_down.hpp"

namespace houghstream::world {

/// Gives the upright rectangle round an asset's shadow on the table, in world x and y.
struct Footprint {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d half = Eigen::Vector2d::Zero();  ///< metres along its own axes
  double yaw_rad = 0.0;
};

/// Returns whether two footprints are nearer than `gap_m` (separating axes of the rectangles).
bool footprints_touch(const Footprint& a, const Footprint& b, double gap_m);

/// Places assets on a table so that no two of them touch.
class TableLayout {
 public:
  explicit TableLayout(const Eigen::Vector2d& table_half) : table_half_(table_half) {}

  /// Returns a free place for the asset `thing` with its centre within `low` to `high` (world x and y, metres), rotated
  /// about the vertical by up to `angle_rad` either way; nothing when none is found.
  std::optional<Eigen::Isometry3d> place(const Asset& thing, const Eigen::AlignedBox2d& region, double angle_rad,
                                         Random& random);

  /// Returns a free footprint of that half extent, as place() does; it is occupied from then on.
  std::optional<Footprint> claim(const Eigen::Vector2d& half, const Eigen::AlignedBox2d& region, double angle_rad,
                                 Random& random);

  /// Keeps a place free of what comes after.
  void take(const Footprint& footprint) { taken_.push_back(footprint); }

  const std::vector<Footprint>& footprints() const { return taken_; }

 private:
  bool on_table(const Footprint& footprint) const;

  Eigen::Vector2d table_half_;
  std::vector<Footprint> taken_;
};

/// Puts assets on a world's table, where there is space for them.
class TableSetter {
 public:
  /// `table_half` is half the extent of the surface, metres. Keeps a reference to `world`.
  TableSetter(World& world, const Eigen::Vector2d& table_half, std::uint64_t seed)
      : world_(world), half_(table_half.cwiseMin(Eigen::Vector2d(0.62, 0.5))), layout_(table_half), random_(seed) {}

  /// Stands the asset upright, rotated by up to `angle_rad` either way. Returns whether there was space.
  bool stand(const AssetPtr& thing, const Eigen::AlignedBox2d& region, double angle_rad, int object_id);

  /// Puts the group down at any rotation. Returns whether there was space.
  bool put(const AssetGroup& group, const Eigen::AlignedBox2d& region);

  /// Stand, lay or tilt a taught object, named in the ground truth unless it is a hard negative (ids 5 to 8). They
  /// throw InputError without space.
  void stand_object(int id, const Eigen::AlignedBox2d& where);
  void lay_object(int id, const Eigen::AlignedBox2d& where);
  void tilt_object(int id, const Eigen::AlignedBox2d& where);
  void lean_object(int id, const Eigen::AlignedBox2d& where);

  /// Puts a taught object into a hand; nothing else is placed below the object or the arm.
  void hold_object(int id, const HeldPlace& place);

  /// Returns a part of the surface, in fractions of its half extent.
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
