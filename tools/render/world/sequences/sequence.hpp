#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/render/world/objects/seeds.hpp"
#include "tools/render/world/scene_frames.hpp"
#include "tools/render/world/sequences/sequence_plan.hpp"

namespace houghstream::world {

/// Holds the state of a sequence at a time.
struct SequenceGroundTruth {
  std::vector<std::optional<Eigen::Isometry3d>> T_world_object;  ///< per actor; nothing where it has been taken away
  std::vector<Eigen::Isometry3d> T_camera_world;                 ///< per camera
};

/// Renders a room with its actors, hands and cameras. Light and shadows are static: moving assets cast none. const
/// calls may be made from several threads at once.
class Sequence {
 public:
  Sequence(SequencePlan plan, DatasetSplit use);

  const SequencePlan& plan() const { return plan_; }
  int cameras() const;
  SequenceGroundTruth truth(double seconds) const;

  /// Renders a camera's frame at that time. Its objects are those of RenderedFrame; the utime stays 0. `index` seeds
  /// the noise.
  RenderedFrame render(int camera, double seconds, int index) const;

 private:
  /// A hand that comes, moves an actor from one stop to the next, and goes.
  struct Carry {
    std::size_t actor = 0;
    std::size_t hand = 0;  ///< index in the world's items
    Eigen::Isometry3d T_object_hand = Eigen::Isometry3d::Identity();
    double start_s = 0.0;
    double end_s = 0.0;
  };

  void furnish();
  void add_actors();
  void add_hands();
  void add_passing_arm();
  Eigen::Isometry3d T_camera_world(int camera, double seconds) const;
  Eigen::Isometry3d T_world_actor(std::size_t actor, double seconds) const;
  World world_at(double seconds) const;

  SequencePlan plan_;
  std::uint64_t seed_;
  LitWorld lit_;
  std::vector<std::size_t> items_;  ///< indices of the actors in the world
  std::vector<Carry> carries_;
  std::optional<std::size_t> arm_;  ///< item of the arm that passes
  Eigen::Isometry3d T_world_arm_ = Eigen::Isometry3d::Identity();
};

}  // namespace houghstream::world
