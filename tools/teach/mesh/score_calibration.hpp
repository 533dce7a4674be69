#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "detector/forest/forest.hpp"
#include "detector/training/profiles.hpp"
#include "drivers/store/practice_record.hpp"
#include "pose/verification/quality.hpp"
#include "tools/render/world/calibration_scenes.hpp"

namespace houghstream::teach {

/// A taught object as calibration needs it.
struct CalibrationObject {
  std::string name;
  Mesh mesh;                                              ///< mesh with which poses are compared, metres
  Eigen::Vector3f vote_centre = Eigen::Vector3f::Zero();  ///< see store::StoredObject
  Symmetries symmetries;                   ///< symmetries of models_info.json: the same pose, texture included
  ShapeSymmetry shape_symmetry;            ///< see store::StoredObject
  world::CalibrationSceneObject in_scene;  ///< its id is the class's
};

struct CalibrationSettings {
  /// Maximum number of scenes, whose images, 4.3 MB a room, are all in memory at once: 2 GB.
  static constexpr int kMaxScenes = 500;

  std::optional<int>
      scenes;  ///< each is looked at world::CalibrationScenes::kFramesPerScene times; default: scene_count_for()
  double surface_variation = 0.6;     ///< strength of the changes of objects' colours, see training::resurface
  double camera_fraction = 0.8;       ///< fraction of the frames that another camera sees than the one that taught
  double camera_randomisation = 0.8;  ///< see detector/training/augmentation/camera_randomisation.hpp
  std::uint64_t seed = 1;
  int threads = 2;
};

/// Results of a calibration for an object.
struct CalibratedObject {
  QualitySettings quality;
  store::PracticeRecord practice;
};

/// Returns the number of rooms in which so many new objects are practised. Without a setting these are as many as one
/// more object in 60 s, and seven in five minutes, leave time for.
int scene_count_for(std::size_t new_objects, const CalibrationSettings& settings = {});

/// Returns the names of the new objects that none of the frames shows, of which nothing can be learnt.
std::vector<std::string> unobserved_objects(const std::vector<world::RenderedFrame>& frames,
                                            const std::vector<CalibrationObject>& objects,
                                            const std::set<int>& new_ids);

/// Returns those of the ids whose objects the forest knows.
std::set<int> new_objects_of(const Forest& forest, const std::set<int>& new_ids);

/// Interleaves a group's objects with the others as distractors, in the order in which scenes are filled: each
/// distractor comes once, and so many come after each of the group's objects that none of these stands twice in one
/// scene.
std::vector<world::CalibrationSceneObject> interleave_distractors(
    const std::vector<world::CalibrationSceneObject>& objects, const std::set<int>& group_ids);

/// Looks for the objects in rendered rooms (world::CalibrationScenes) through widely varied cameras, and learns what
/// its detections and poses are worth: the scores' weights in the groups' forests, and the qualities, with what was
/// found by them, by name; both of the classes in `new_ids` only. Each group with such classes has rooms of its own,
/// scene_count_for() many, in which the other groups' objects stand as distractors, and where all groups are searched
/// together: what one finds may suppress what another finds. The result is independent of what was learnt before of the
/// classes in `new_ids`. A line of the log names those of them that stand in no room. Same result for any number of
/// threads. Throws InputError for more rooms of a group than CalibrationSettings::kMaxScenes.
std::map<std::string, CalibratedObject> calibrate_on_scenes(const std::vector<CalibrationObject>& objects,
                                                            const std::set<int>& new_ids,
                                                            const CalibrationSettings& settings,
                                                            std::vector<Forest>& groups);

}  // namespace houghstream::teach
