#pragma once

#include <map>
#include <string>

#include "drivers/files/json_file.hpp"
#include "drivers/store/object_store.hpp"
#include "pose/verification/quality.hpp"

namespace houghstream {

/// As the object store holds it: {"bias", "weights": {TERM: }, "typical": {TERM: }}.
nlohmann::json quality_to_json(const QualitySettings& settings);

/// What the store has learnt of its objects' qualities, by name; `least` of each is that of `others`. Throws InputError
/// naming the store for a missing or unknown number.
std::map<std::string, QualitySettings> stored_quality(const store::ObjectStore& objects, const QualitySettings& others);

}  // namespace houghstream
