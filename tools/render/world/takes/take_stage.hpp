#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/objects/seeds.hpp"
#include "tools/render/world/objects/world.hpp"
#include "tools/render/world/takes/hand_path.hpp"

namespace houghstream::world {

/// Kind of a take.
enum class TakeKind : std::uint8_t {
  kHandHeld,   ///< it stands on a table, the camera is carried round it
  kTurntable,  ///< it stands on a turntable before a static camera
  kHandTurns   ///< before a static camera, a hand rotates the object a part of a turn at a time
};

/// Returns "hand_held", "turntable" or "hand_turns".
std::string take_kind_name(TakeKind kind);

/// Plans one recording of an object being shown.
struct TakePlan {
  int object_id = 1;  ///< id for make_taught_object()
  TakeKind kind = TakeKind::kHandHeld;
  bool laid_down = false;  ///< on its side or upside down; else upright
  DatasetSplit use = DatasetSplit::kTest;
  std::uint64_t number = 0;  ///< number of the world: takes of one number share a room, whatever its objects do
  double seconds = 16.0;
};

/// Holds the room of a take, with all its moving assets.
class TakeStage {
 public:
  explicit TakeStage(const TakePlan& plan);

  /// Returns the world at 0 seconds.
  const World& world() const { return world_; }

  /// Moves assets to their poses at a time; `world` is a copy of world(). Returns T_camera_world.
  Eigen::Isometry3d move(World& world, double seconds) const;

  /// Returns whether anything but the camera moves, and the shadows with it.
  bool things_move() const { return kind_ != TakeKind::kHandHeld; }

  /// Seed of one aspect of the take that has nothing to do with the stage.
  std::uint64_t seed() const { return seed_; }

 private:
  /// A hand that takes hold of the object, turns it, and goes away again.
  struct Stroke {
    std::size_t hand = 0;             ///< index in the world's items
    Eigen::Isometry3d T_object_hand;  ///< while it holds
    double start_s = 0.0;
    double seconds = 0.0;
    double start_rad = 0.0;
  };

  void furnish(const TakePlan& plan);
  void put_object(const TakePlan& plan);
  void add_turntable(const TakePlan& plan);
  void add_hands();
  void choose_camera(const TakePlan& plan);
  Eigen::Isometry3d object_at(double rotated_rad) const;
  double rotated_rad(double seconds) const;
  void move_hand(const Stroke& stroke, double seconds, World& world) const;

  TakeKind kind_;
  std::uint64_t seed_;
  double seconds_;
  World world_;
  std::size_t object_ = 0;  ///< index in world_.items
  std::optional<std::size_t> turntable_;
  std::optional<HandPath> path_;                                     ///< path of a camera that is carried
  Eigen::Isometry3d T_still_world_ = Eigen::Isometry3d::Identity();  ///< pose of a static camera
  std::optional<UnevenProgress> turning_;                            ///< progress of a turntable
  std::vector<Stroke> strokes_;
};

}  // namespace houghstream::world
