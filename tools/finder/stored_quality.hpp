#pragma once

#include <map>
#include <optional>
#include <string>

#include "drivers/files/json_file.hpp"
#include "drivers/store/object_store.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// Smallest quality of a published pose of a store's objects: in synthetic scenes that the fit has not seen 98 % of the
/// poses from there on were right. Of a candidate's: the same share in the development rooms, where most candidates are
/// false.
constexpr float kStoreQuality = 0.6F;
constexpr float kStoreCandidateQuality = 0.75F;

/// Converts qualities to the JSON of an object store: {"bias", "weights": {TERM: }, "typical": {TERM: }, "presence":
/// {"bias", "of_score", "of_quality"}, "print": {"bias", "of_margin"}}.
nlohmann::json quality_to_json(const QualitySettings& settings);

/// Returns the quality settings that the store has learnt for its objects, by name; the thresholds of each are those of
/// `others`. Throws InputError naming the store for a missing or unknown number, and for one out of its range. A store
/// that was taught before presence or texture was learnt has that of `others`.
std::map<std::string, QualitySettings> stored_quality(const store::ObjectStore& objects, const QualitySettings& others);

/// Returns the pose settings, composed in this order: `common`; of a store, where there is one, its learnt qualities,
/// the threshold of its poses, the centres of its detections, its symmetries, and its brightness; `min_quality` of a
/// command line, which then is the threshold of all poses.
PoseSettings pose_settings_of(PoseSettings common, const std::optional<store::ObjectStore>& objects,
                              std::optional<float> min_quality);

/// Makes settings with which every pose is published, for an evaluation of all poses.
inline PoseSettings without_rejection(PoseSettings settings) {
  set_min_quality(0.0F, settings);
  settings.min_publication_probability = 0.0F;
  return settings;
}

}  // namespace houghstream
