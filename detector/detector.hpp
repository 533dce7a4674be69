#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "detector/detection_settings.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// The memory of a search, see stages.hpp.
struct DetectorWorkspace;

/// Finds the taught objects in an RGB-D frame: depth-normalised Hough Forest (Haensch, Kaiser, Hellwich,
/// VISAPP 2017, after Gall et al., PAMI 2011). Several threads may use one detector, each with a workspace of its own.
class Detector {
 public:
  /// Throws InputError for a forest of another ScaleHandling than depth normalisation and for one with surface
  /// features: such are searched by hs-study evaluate and hs-study hough; and for settings out of their range.
  Detector(Forest forest, DetectionSettings settings);
  /// Searches the forests of several groups of objects in one go: working images, patches and features of a frame are
  /// computed once, each forest casts its votes, and their candidates suppress one another. Throws InputError as above,
  /// for no group, for two objects of one name or id, and for a group of other settings than the first's, which could
  /// not share its features.
  Detector(std::vector<Forest> groups, DetectionSettings settings);
  ~Detector();
  Detector(Detector&&) noexcept;

  /// Detections from EvidenceSettings::threshold_of() their class on, strongest first, with stage times "detect.*"
  /// appended to the frame's. Same forest, frame and settings: same result, bit for bit, for any number of threads,
  /// whatever the workspace was used for before. Throws InputError unless the frame's images and camera agree.
  /// `camera_colours`: objects that the frame's camera has seen before, of which it is learnt how it renders colours
  /// (CameraChroma), beside those of the frame.
  /// `selected`: indices of the groups that are searched, ascending (GroupSchedule); empty: all. An object is found as
  /// with all groups, but for what the others' objects suppress, explain, teach of the camera's colours, or displace
  /// from the EvidenceSettings::max_compared hypotheses. Throws std::logic_error for other indices.
  Detections detect(const RgbdFrame& frame, DetectorWorkspace& workspace,
                    const std::vector<ChromaPair>& camera_colours = {},
                    const std::vector<std::size_t>& selected = {}) const;

  /// Searches a single frame, with a workspace that it makes for this call.
  Detections detect(const RgbdFrame& frame) const;

  /// Returns the groups' forests, in the order in which they were given.
  const std::vector<Forest>& groups() const;
  /// The groups, for another detector; this one is not to be used any more.
  std::vector<Forest> take_groups() &&;

  // The names of before, for one release, of the first group.
  [[deprecated("is groups now")]] const Forest& forest() const { return groups().front(); }
  [[deprecated("is take_groups now")]] Forest take_forest() && { return std::move(*this).take_groups().front(); }

  const DetectionSettings& settings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace houghstream
