#pragma once

#include <cstdint>
#include <vector>

#include "tools/render/world/mesh_views.hpp"
#include "tools/render/world/scene_frames.hpp"

namespace houghstream::world {

/// A mesh that stands about in calibration scenes.
struct CalibrationSceneObject {
  int id = 0;
  AssetPtr thing;
  std::vector<Eigen::Vector3d> ups;  ///< object frame, see up_directions(); empty = any attitude
  bool has_colour = true;            ///< false: another uniform colour in every room
  bool is_calibrated = true;         ///< each room has at least one such object; others accompany it
};

/// Renders the scenes on which taught objects are calibrated: furnished rooms with the objects, all round and in their
/// attitudes, among distractors; some of those have an object's shape in other colours or its appearance in another
/// size. Objects stand on, beside and behind others, unlike images composed from views. The rooms have training seeds
/// that neither views nor backgrounds use.
class CalibrationScenes {
 public:
  static constexpr int kFramesPerScene = 2;

  /// At least one of the `objects` must be one to calibrate.
  CalibrationScenes(std::vector<CalibrationSceneObject> objects, std::uint64_t seed)
      : objects_(std::move(objects)), seed_(seed) {}

  /// Renders room `room`, from 0, from different sides and distances. The ground truth names objects by
  /// CalibrationSceneObject::id. The same arguments give the same frames; thread-safe.
  std::array<RenderedFrame, kFramesPerScene> render(int room) const;

 private:
  World make_furnished_world(int room) const;

  std::vector<CalibrationSceneObject> objects_;
  std::uint64_t seed_;
};

}  // namespace houghstream::world
