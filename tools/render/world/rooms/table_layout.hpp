#pragma once

#include <optional>
#include <vector>

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {

/// Upright rectangle round a thing's shadow on the table, in world x and y.
struct Footprint {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d half = Eigen::Vector2d::Zero();  ///< metres along its own axes
  double yaw_rad = 0.0;
};

/// Whether two footprints come nearer than `gap_m` (separating axes of the rectangles).
bool footprints_touch(const Footprint& a, const Footprint& b, double gap_m);

/// Stands things on a table so that no two of them touch.
class TableLayout {
 public:
  explicit TableLayout(const Eigen::Vector2d& table_half) : table_half_(table_half) {}

  /// A free place for `thing` with its centre within `low` to `high` (world x and y, metres), turned about the
  /// vertical by up to `turn_rad` either way; nothing when none is found.
  std::optional<Eigen::Isometry3d> place(const Thing& thing, const Eigen::AlignedBox2d& region, double turn_rad,
                                         Random& random);

  /// A free footprint of that half extent, as for place(); it is taken from then on.
  std::optional<Footprint> claim(const Eigen::Vector2d& half, const Eigen::AlignedBox2d& region, double turn_rad,
                                 Random& random);

  /// Keeps a place free of what comes after.
  void take(const Footprint& footprint) { taken_.push_back(footprint); }

  const std::vector<Footprint>& footprints() const { return taken_; }

 private:
  bool on_table(const Footprint& footprint) const;

  Eigen::Vector2d table_half_;
  std::vector<Footprint> taken_;
};

}  // namespace houghstream::world
