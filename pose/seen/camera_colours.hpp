#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

/// What confirmed poses have told of how one camera renders colours. Each class is remembered once, as its later frames
/// tell hardly more of the camera than its first one, with its colours averaged over the last few frames.
class CameraColours {
 public:
  /// Takes up the poses of a frame: those that are valid and sure. Where the light has jumped, all that was remembered
  /// is forgotten first.
  void update(const ObjectPoses& poses);

  /// One for each remembered class, in their order.
  std::vector<ChromaPair> pairs() const;
  /// The same with the newest frame that was learnt from.
  CameraChroma chroma() const { return {frame_, pairs()}; }
  /// Learnt of all remembered classes but this one.
  ChromaMap map_without(const std::string& class_name) const;
  /// Learnt of all remembered classes.
  ChromaMap map() const;

 private:
  bool has_jumped(const std::vector<ChromaPair>& confirmed) const;

  FrameId frame_;
  std::map<std::string, ChromaPair> remembered_;  // by class
  int jumps_ = 0;                                 // frames one after the other that contradict what is remembered
};

}  // namespace houghstream
