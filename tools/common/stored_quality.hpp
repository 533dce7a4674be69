#pragma once

#include <map>
#include <optional>
#include <string>

#include "drivers/files/json_file.hpp"
#include "drivers/store/object_store.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// Smallest quality of a published pose of a store's objects: in practice rooms that the fit has not seen 98 % of the
/// poses from there on were right. Of a candidate's: the same share in the development rooms, where most candidates are
/// false.
constexpr float kStoreQuality = 0.6F;
constexpr float kStoreCandidateQuality = 0.75F;

/// As the object store holds it: {"bias", "weights": {TERM: }, "typical": {TERM: }, "presence": {"bias",
/// "score_weight", "quality_weight"}}.
nlohmann::json quality_to_json(const QualitySettings& settings);

/// What the store has learnt of its objects' qualities, by name; the limits of each are those of `others`. Throws
/// InputError naming the store for a missing or unknown number. A store that
/// was taught before presence was learnt has that of `others`.
std::map<std::string, QualitySettings> stored_quality(const store::ObjectStore& objects, const QualitySettings& others);

/// What hs-pose needs to know of a store beside its meshes: qualities, where detections' centres are, and what looks
/// alike. Poses are published from `min_quality` on, where it is given.
void apply_store_settings(const store::ObjectStore& objects, std::optional<float> min_quality, PoseSettings& settings);

}  // namespace houghstream
