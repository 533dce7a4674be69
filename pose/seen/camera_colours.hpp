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
  /// Updates the colours from the poses of a frame that are valid and sure. Where the lighting has jumped, all stored
  /// colours are dropped first.
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
  std::map<std::string, ChromaPair> remembered_;  // pairs by class name
  int jumps_ = 0;                                 // consecutive frames that contradict the stored colours
};

}  // namespace houghstream
