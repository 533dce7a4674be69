#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "pipeline/types/object_pose.hpp"

namespace houghstream::tracks {

/// Which classes a result speaks of, by having no pose of them. It does not say what was looked for: of one detector it
/// is everything. Where several work on a camera's frames (two results of one frame have had no class in common), a
/// result speaks of its own classes and of those that have been told of together with them, and of one whose own
/// detector has told nothing for a second. Poses without a model are somebody else's. Not thread-safe.
class SearchedClasses {
 public:
  /// To be told of each result, before it is asked about it.
  void note(const ObjectPoses& poses);

  bool has_searched(const ObjectPoses& poses, const std::string& class_name) const;

  /// Forgets all other classes: a sender of rubbish may make up names without end.
  void keep_only(const std::set<std::string>& classes);

 private:
  struct Coverage {
    std::set<std::string> classes;  // that were told of in one result with it
    std::int64_t utime = 0;         // when it was told of last
  };
  struct Camera {
    std::int64_t utime = 0;         // of the last frame
    std::set<std::string> classes;  // that it was told of
    bool has_several = false;       // detectors
  };

  bool is_reporting(const std::string& class_name, std::int64_t utime) const;

  std::map<std::string, Coverage> companies_;  // by class
  std::map<std::string, Camera> cameras_;      // by channel
};

}  // namespace houghstream::tracks
