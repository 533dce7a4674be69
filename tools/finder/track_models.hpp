#pragma once

#include <string>

#include "drivers/store/object_store.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream {

/// Loads what hs-track knows of classes from a folder of models: meshes and symmetries, as load_class_models() reads
/// them. Without models_info.json no class has symmetries. Throws InputError.
tracks::TrackModels load_track_models(const std::string& folder, double unit_m);

/// Loads the same from an object store, with the numbers of its objects and the centres of their votes.
tracks::TrackModels stored_track_models(const store::ObjectStore& store);

}  // namespace houghstream
