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
  bool has_colour = true;            ///< false: another plain colour in every room
  bool is_calibrated = true;         ///< each room has at least one such object; others accompany it
};

/// Images in which taught objects are looked for before they count as taught: furnished rooms with the objects, all
/// round and in their attitudes, among things that are none of them; some of those have an object's shape in other
/// colours or its look in another size. Standing on something, beside and behind other things, as images put together
/// from views never are. Rooms of training seeds that neither views nor backgrounds use.
class CalibrationScenes {
 public:
  static constexpr int kFramesPerScene = 2;

  /// At least one of the `objects` must be one to calibrate.
  CalibrationScenes(std::vector<CalibrationSceneObject> objects, std::uint64_t seed)
      : objects_(std::move(objects)), seed_(seed) {}

  /// Looks at room `room`, from 0, from different sides and distances. The truth names objects by
  /// CalibrationSceneObject::id. Same arguments, same frames; thread-safe.
  std::array<RenderedFrame, kFramesPerScene> render(int room) const;

 private:
  World make_furnished_world(int room) const;

  std::vector<CalibrationSceneObject> objects_;
  std::uint64_t seed_;
};

}  // namespace houghstream::world
