#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "detector/forest/forest.hpp"
#include "detector/profiles.hpp"
#include "pose/verification/quality.hpp"
#include "tools/render/world/practice_scenes.hpp"

namespace houghstream::teach {

/// A taught object as practice needs it.
struct PractisedObject {
  std::string name;
  Mesh mesh;                                              ///< as poses are compared with it, metres
  Eigen::Vector3f vote_centre = Eigen::Vector3f::Zero();  ///< see store::StoredObject
  world::PracticeObject in_room;                          ///< its id is the class's
};

struct PracticeSettings {
  int rooms = 60;                  ///< each is looked at world::PracticeScenes::kFramesPerRoom times
  double surface_variation = 0.6;  ///< strength of the changes of objects' colours, see training::resurface
  double camera_share = 0.8;       ///< of the frames, that another camera sees than the one that taught
  double camera_variation = 0.8;   ///< see detector/training/pictures/camera_variation.hpp
  std::uint64_t seed = 1;
  int threads = 2;
};

/// Looks for the objects in rendered rooms (world::PracticeScenes) through widely varied cameras, and learns what its
/// detections and poses are worth: the scores' weights in `forest`, and the qualities, by name; both of the classes in
/// `new_ids` only. Same result for any number of threads.
std::map<std::string, QualitySettings> practise(const std::vector<PractisedObject>& objects,
                                                const std::set<int>& new_ids, const PracticeSettings& settings,
                                                Forest& forest);

}  // namespace houghstream::teach
