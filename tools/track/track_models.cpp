#include "tools/track/track_models.hpp"

#include "drivers/datasets/bop_dataset.hpp"

namespace houghstream::track {

tracks::TrackModels load_track_models(const std::string& folder, double unit_m) {
  std::map<std::string, Symmetries> symmetries;
  if (std::filesystem::exists(std::filesystem::path(folder) / "models_info.json")) {
    const BopModels models = read_bop_models(folder);
    for (const auto& [id, of_object] : models.symmetries) symmetries[models.names.at(id)] = of_object;
  }
  return tracks::make_track_models(load_class_models(folder, unit_m), symmetries);
}

tracks::TrackModels stored_track_models(const store::ObjectStore& store) {
  std::map<std::string, Symmetries> symmetries;
  for (const store::StoredObject& object : store.objects) symmetries[object.name] = store.symmetries.at(object.id);
  tracks::TrackModels models = tracks::make_track_models(store::load_store_meshes(store), symmetries);
  for (const store::StoredObject& object : store.objects) {
    tracks::TrackModel& model = models.at(object.name);
    model.vote_centre = object.vote_centre.cast<double>();
    model.object_id = object.id;
  }
  return models;
}

}  // namespace houghstream::track
