#pragma once

#include <string>

#include "drivers/store/object_store.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::track {

/// Meshes and symmetries of a folder of models, as load_class_models() reads it. Where the folder does not say them
/// (there is no models_info.json), nothing looks the same in two poses. Throws InputError.
tracks::TrackModels load_track_models(const std::string& folder, double unit_m);

/// Those of an object store.
tracks::TrackModels stored_track_models(const store::ObjectStore& store);

}  // namespace houghstream::track
