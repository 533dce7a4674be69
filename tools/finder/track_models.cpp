#include "tools/finder/track_models.hpp"

#include "drivers/datasets/bop_dataset.hpp"

namespace houghstream {

tracks::TrackModels load_track_models(const std::string& folder, double unit_m) {
  return tracks::make_track_models(load_class_models(folder, unit_m), load_class_symmetries(folder));
}

tracks::TrackModels stored_track_models(const store::ObjectStore& store) {
  tracks::TrackModels models = tracks::make_track_models(store::load_store_meshes(store), store.symmetries_by_name());
  for (const store::StoredObject& object : store.objects) {
    tracks::TrackModel& model = models.at(object.name);
    model.vote_centre = object.vote_centre.cast<double>();
    model.object_id = object.id;
    model.frames = object.frames;
  }
  return models;
}

}  // namespace houghstream
