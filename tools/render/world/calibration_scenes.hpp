#pragma once

#include <cstdint>
#include <optional>
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

/// Settings of the scenes; the defaults are those of calibration.
struct CalibrationSceneSettings {
  int frames = 2;  ///< frames of a room, from different sides and distances
  /// Range of the number of objects that are put on the table; those for which there is no space are left out.
  int min_objects = 3;
  int max_objects = 7;
  /// Range of the part of the table on which they are put, as a fraction of its half extent: near together they occlude
  /// one another.
  double min_reach = 0.35;
  double max_reach = 0.8;
  bool varies_instances = true;  ///< false: every instance has the shape of its mesh
  std::optional<Camera> camera;  ///< camera of all rooms; nothing: each room has another one
};

/// Renders the scenes on which taught objects are calibrated: furnished rooms with the objects, all round and in their
/// attitudes, among distractors; some of those have an object's shape in other colours or its appearance in another
/// size. Objects stand on, beside and behind others, unlike images composed from views. The rooms have training seeds
/// that neither views nor backgrounds use.
class CalibrationScenes {
 public:
  static constexpr int kFramesPerScene = CalibrationSceneSettings{}.frames;

  /// At least one of the `objects` must be one to calibrate.
  CalibrationScenes(std::vector<CalibrationSceneObject> objects, std::uint64_t seed,
                    CalibrationSceneSettings settings = {})
      : objects_(std::move(objects)), seed_(seed), settings_(std::move(settings)) {}

  /// Renders room `room`, from 0, in CalibrationSceneSettings::frames frames. The ground truth names objects by
  /// CalibrationSceneObject::id. The same arguments give the same frames; thread-safe.
  std::vector<RenderedFrame> render(int room) const;

 private:
  World make_furnished_world(int room) const;

  std::vector<CalibrationSceneObject> objects_;
  std::uint64_t seed_;
  CalibrationSceneSettings settings_;
};

}  // namespace houghstream::world
