#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

/// Collects from confirmed poses how one camera renders colours. Each class is stored once, since its later frames add
/// little to its first one, with its colours averaged over the last few frames.
class CameraColours {
 public:
  /// Takes up the poses of a frame: those that are valid and sure. Where the light has jumped, all that was remembered
  /// is forgotten first.
  void update(const ObjectPoses& poses);

  /// Returns one pair for each stored class, in their order.
  std::vector<ChromaPair> pairs() const;
  /// Returns the same pairs with the newest frame that contributed.
  CameraChroma chroma() const { return {frame_, pairs()}; }
  /// Returns the map learnt from all stored classes but this one.
  ChromaMap map_without(const std::string& class_name) const;
  /// Returns the map learnt from all stored classes.
  ChromaMap map() const;

 private:
  bool has_jumped(const std::vector<ChromaPair>& confirmed) const;

  FrameId frame_;
  std::map<std::string, ChromaPair> remembered_;  // by class name
  int jumps_ = 0;                                 // frames one after the other that contradict what is remembered
};

}  // namespace houghstream
