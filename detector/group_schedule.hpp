#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame_id.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

struct Forest;

/// Settings of GroupSchedule.
struct GroupScheduleSettings {
  double active_s = 1.0;  ///< time for which a group is active after one of its objects was found
  /// Time within which each inactive group is searched again, or in the first frame after that; 0: in every frame.
  double interval_s = 0.2;
};

template <typename Visit>
void fields(const GroupScheduleSettings& /*settings*/, const Visit& visit) {
  using S = GroupScheduleSettings;
  visit(number("active_s", &S::active_s, 0, 3600, "s"));
  visit(number("interval_s", &S::interval_s, 0, 3600, "s"));
}

/// Chooses the groups of a Detector that are searched in each frame of a stream: active groups, whose objects were
/// found lately, in every frame, and the others in turn, so that time does not grow with objects that are not in view.
/// An object is found where its pose is published; without poses, where its detection is reported. In most frames each
/// group has some weak detection, which therefore counts for nothing. Times are those of the frames: the same frames
/// and results give the same choice. Each camera has a turn of its own. Not thread-safe.
class GroupSchedule {
 public:
  /// Maximum number of cameras with a turn of their own; of a further one all groups are searched in every frame. An
  /// untrusted sender may make up channels without end.
  static constexpr std::size_t kCameras = 64;

  /// Makes a schedule for the groups that Detector::groups() returns. Throws InputError for settings out of their
  /// range.
  explicit GroupSchedule(const std::vector<Forest>& groups, const GroupScheduleSettings& settings = {});

  /// Returns the indices of the groups to be searched in this frame, ascending, and counts them as searched: all of
  /// them in a camera's first frame; then the active ones, the inactive ones whose last search lies `interval_s` back
  /// or more, and of the other inactive ones those that were searched longest ago: one each time that all of them
  /// together have waited `interval_s`, so that frames take about equally long. There is always one. A frame that is
  /// older than the one before it by up to a second was overtaken in transit: no time has passed. Times that go back by
  /// more restart the camera.
  std::vector<std::size_t> select(const FrameId& frame);

  /// Makes the groups active of which a detection is reported, unless poses were noted within `active_s`. Classes that
  /// no group has, and cameras that select() does not know, are ignored.
  void note(const Detections& detections);

  /// Makes the groups active of which there is a pose. Poses without a model say nothing.
  void note(const ObjectPoses& poses);

 private:
  struct Turn {
    std::int64_t searched_frame = 0;  // number of the frame of the last search; 0 before the first
    std::int64_t searched_utime = 0;
    std::optional<std::int64_t> found_utime;
  };
  struct Camera {
    std::int64_t utime = 0;                   // time of its newest frame
    std::int64_t frames = 0;                  // number of its frames so far
    double waited_s = 0.0;                    // by all inactive groups together since the last of their searches
    std::optional<std::int64_t> posed_utime;  // its time when poses were last noted
    std::vector<Turn> turns;                  // by group
  };

  bool is_recent(const std::optional<std::int64_t>& then, std::int64_t utime) const;
  void activate(const std::string& class_name, Camera& camera) const;
  bool is_overdue(const Turn& turn, std::int64_t utime) const;

  GroupScheduleSettings settings_;
  std::size_t group_count_;
  std::map<std::string, std::size_t> group_of_class_;  // by class name
  std::map<std::string, Camera> cameras_;              // by channel name
};

}  // namespace houghstream
