#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pipeline/types/tracked_object.hpp"

namespace houghstream {

struct FinderOptions {
  int threads = 2;                   ///< any number gives the same result
  std::optional<float> threshold;    ///< smallest score that is reported, 0 to 1; default: that of hs-detect
  std::optional<float> min_quality;  ///< smallest quality of a pose that is valid, 0 to 1; default: that of hs-pose
  /// Instead of both: fraction of what is reported that is to be right, 0 to below 1. Each object has the least score
  /// and quality that its practice (hs-teach) needed for it.
  std::optional<double> precision = std::nullopt;
};

/// Objects of one frame. Both lists are of the same frame; poses[i] belongs to detections[i]. The object is found where
/// is_reported() says so: other detections are candidates that no pose has confirmed.
struct FoundObjects {
  Detections detections;  ///< strongest first: class, score, box in pixels, centre in metres
  ObjectPoses poses;      ///< a pose into the camera's frame where status is kValid, else the reason why there is none
};

/// An object that a finder looks for.
struct FinderObject {
  std::string name;
  Eigen::AlignedBox3d bounds;  ///< bounds of its mesh, object frame, metres
};

/// Finds the objects of an object store (hs-teach) in single frames, within one's own program and without LCM: what
/// hs-detect and hs-pose do in a stream. Calls of one finder follow one another; several threads take one each.
class ObjectFinder {
 public:
  /// Throws InputError with one line where the store is none, half written or of another version; for a precision
  /// beside a threshold or quality, out of its range, or of which the store's practice knows nothing.
  explicit ObjectFinder(const std::filesystem::path& store, const FinderOptions& options = {});
  ~ObjectFinder();
  ObjectFinder(ObjectFinder&&) noexcept;

  /// Colour, depth and camera as RgbdFrame states them; the frame's name may be empty. Same frame, same result, bit for
  /// bit. Throws InputError where they do not agree.
  FoundObjects find(const RgbdFrame& frame);

  /// Objects of the store, sorted by name.
  const std::vector<FinderObject>& objects() const;

  /// Covariance of a pose that find() has returned: translation, m^2, then rotation, rad^2, along and about the
  /// camera's axes. Throws InputError for a result without a pose, and for an object that is not of the store.
  Covariance6 covariance(const ObjectPose& pose) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace houghstream
