#include "tools/teach/mesh/teach_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <optional>
#include <set>

#include "detector/forest/forest_file.hpp"
#include "detector/training/object_removal.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "drivers/store/object_store.hpp"
#include "drivers/store/store_transaction.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/parallel.hpp"
#include "pose/model/symmetry_search.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/finder/stored_quality.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"
#include "tools/teach/mesh/lookalikes.hpp"
#include "tools/teach/mesh/stop_notice.hpp"
#include "tools/teach/mesh/store_summary.hpp"
#include "tools/teach/mesh/store_training.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using store::ObjectStore;
using store::StoredObject;

/// A line for each step, with the seconds since the start.
class Progress {
 public:
  void operator()(const std::string& line) const { fmt::print(stderr, "hs-teach: {:6.1f} s  {}\n", seconds(), line); }
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// A store with its forest and meshes, all of it in memory.
struct Contents {
  ObjectStore list;
  std::optional<Forest> forest;
  std::map<std::string, Mesh> meshes;
};

Contents read_contents(const fs::path& folder) {
  Contents contents;
  contents.list = store::read_store(folder);
  contents.meshes = store::load_store_meshes(contents.list);
  contents.forest = load_store_forest(contents.list);
  return contents;
}

/// Ids of BOP folders are kept where they are free; what has none, or another object's, gets the next free one.
void give_ids(const ObjectStore& old, std::vector<TaughtMesh>& meshes) {
  std::vector<int> taken;
  for (const StoredObject& object : old.objects) taken.push_back(object.id);
  const auto is_free = [&](int id) { return std::find(taken.begin(), taken.end(), id) == taken.end(); };
  for (TaughtMesh& mesh : meshes) {
    if (mesh.id > 0 && !is_free(mesh.id)) mesh.id = 0;
    if (mesh.id > 0) taken.push_back(mesh.id);
  }
  for (TaughtMesh& mesh : meshes) {
    if (mesh.id > 0) continue;
    for (mesh.id = 1; !is_free(mesh.id);) ++mesh.id;
    taken.push_back(mesh.id);
  }
  std::sort(meshes.begin(), meshes.end(), [](const TaughtMesh& a, const TaughtMesh& b) { return a.id < b.id; });
}

void require_new(const ObjectStore& old, const std::vector<TaughtMesh>& meshes) {
  for (const TaughtMesh& mesh : meshes) {
    const bool is_known = std::any_of(old.objects.begin(), old.objects.end(),
                                      [&](const StoredObject& object) { return object.name == mesh.name; });
    require(!is_known, "{}: the store {} has a '{}' already, expected a new name (--names), or hs-teach remove first",
            mesh.file.string(), old.folder.string(), mesh.name);
  }
}

using Practice = std::map<std::string, PracticeCount>;

/// The objects of the finished store, looked for in rooms; what is learnt of the new ones goes into forest and store.
Practice calibrate_all(const std::vector<NamedModel>& models, const std::set<int>& new_ids,
                       const CalibrationSettings& settings, Forest& forest, ObjectStore& made) {
  std::vector<CalibrationObject> objects(models.size());
  parallel_for(settings.threads, static_cast<int>(models.size()), [&](int i) {
    const NamedModel& model = models[static_cast<std::size_t>(i)];
    const auto of_model = [&](const StoredObject& object) { return object.id == model.object_id; };
    const StoredObject& stored = *std::find_if(made.objects.begin(), made.objects.end(), of_model);
    CalibrationObject& object = objects[static_cast<std::size_t>(i)];
    object.name = model.name;
    object.mesh = model.mesh;
    object.vote_centre = stored.vote_centre;
    object.symmetries = model.symmetries;
    object.shape_symmetry = *stored.shape_symmetry;
    object.in_scene.id = model.object_id;
    object.in_scene.thing = world::make_taught_thing(model.mesh, stored.coloured);
    object.in_scene.ups = world::up_directions(model.mesh, world::parse_mesh_attitudes(stored.attitudes));
    object.in_scene.has_colour = stored.coloured;
    object.in_scene.is_calibrated = new_ids.count(model.object_id) > 0;
  });
  const std::map<std::string, CalibratedObject> learnt = calibrate_on_scenes(objects, new_ids, settings, forest);
  Practice practice;
  for (StoredObject& object : made.objects) {
    const auto found = learnt.find(object.name);
    if (found == learnt.end()) continue;
    object.quality = quality_to_json(found->second.quality);
    practice[object.name] = found->second.practice;
  }
  return practice;
}

std::string unchanged_notice(const fs::path& folder) {
  return fmt::format("hs-teach: stopped; {}",
                     fs::exists(folder) ? folder.string() + " is as it was" : "nothing was made in " + folder.string());
}

std::string calibration_step(const CalibrationSettings& settings, std::size_t new_objects) {
  return fmt::format("looked for in {} rendered rooms, of which scores and qualities are learnt",
                     scene_count_for(new_objects, settings));
}

/// The forest's classes get the ids of the store.
void take_ids(const ObjectStore& list, Forest& forest) {
  for (ObjectClass& known : forest.classes) {
    for (const StoredObject& object : list.objects) {
      if (object.name == known.name) known.class_id = object.id;
    }
  }
}

/// Everything but the images of views, which are there, and store.json last. All of it is read back: a store that
/// nothing can read must not take the place of one that works.
void write_store(ObjectStore list, const std::vector<NamedModel>& models, const Forest& forest) {
  std::sort(list.objects.begin(), list.objects.end(),
            [](const StoredObject& a, const StoredObject& b) { return a.id < b.id; });
  write_bop_models(models, list.models_folder());
  save_forest(forest, list.forest_file());
  std::vector<fs::path> images;
  for (const StoredObject& object : list.objects) images.push_back(list.view_image(object.id));
  write_contact_sheet(images, list.contact_sheet());
  list.tone = forest.features.tone;
  store::write_store_json(list);
  load_store_forest(store::read_store(list.folder));
}

/// Copies the unchanged part of a store into the new one.
void keep(const Contents& old, const std::string& except, ObjectStore& made, std::vector<NamedModel>& models) {
  for (const StoredObject& object : old.list.objects) {
    if (object.name == except) continue;
    made.objects.push_back(object);
    std::optional<ShapeSymmetry>& shape = made.objects.back().shape_symmetry;
    if (!shape) shape = find_shape_symmetry(old.meshes.at(object.name));  // taught before it was looked for
    models.push_back({object.id, object.name, old.meshes.at(object.name), old.list.symmetries.at(object.id)});
    std::error_code error;
    fs::copy_file(old.list.view_image(object.id), made.view_image(object.id), error);
    require(!error, "{}: cannot be copied: {}", old.list.view_image(object.id).string(), error.message());
  }
}

/// All objects are meant where no names are given.
std::set<int> ids_of(const ObjectStore& list, const std::vector<std::string>& names) {
  std::set<int> ids;
  for (const std::string& name : names) ids.insert(store::find_object(list, name).id);
  if (!names.empty()) return ids;
  for (const StoredObject& object : list.objects) ids.insert(object.id);
  return ids;
}

ObjectStore start_store(const fs::path& folder) {
  ObjectStore made;
  made.folder = folder;
  std::error_code error;
  fs::create_directories(folder / "views", error);
  require(!error, "{}: cannot make this folder: {}", (folder / "views").string(), error.message());
  return made;
}

/// Nothing is made beside what is no store.
void require_store(const fs::path& folder) {
  store::recover_store(folder);
  store::read_store(folder);
}

/// Views of another teaching would be taken for this one's.
void require_free(const fs::path& dump) {
  std::error_code error;
  require(dump.empty() || !fs::exists(dump, error) || (fs::is_directory(dump, error) && fs::is_empty(dump, error)),
          "--dump-views {}: holds something already, expected a new folder or an empty one", dump.string());
}

void name_lookalikes(const std::vector<NamedModel>& models) {
  std::vector<NamedMesh> named;
  named.reserve(models.size());
  for (const NamedModel& model : models) named.emplace_back(model.name, &model.mesh);
  for (const Lookalike& pair : find_lookalikes(named)) log_warning("{}", describe(pair));
}

}  // namespace

void require_no_store(const fs::path& folder) {
  ObjectStore there;
  there.folder = folder;
  if (!fs::exists(there.json_file())) return;
  try {
    there = store::read_store(folder);
  } catch (const InputError& error) {  // of another version, for one: somebody else may read it
    fail("{}: an object store that cannot be read ({}), expected --replace to put a new one in its place",
         folder.string(), error.what());
  }
  fail("{}: holds {} object{}, expected --add to add to it, or --replace to put a new one in its place",
       folder.string(), there.objects.size(), there.objects.size() == 1 ? "" : "s");
}

void teach_meshes(const TeachOptions& options) {
  const Progress progress;
  StopNotice stop(unchanged_notice(options.out));
  world::parse_mesh_attitudes(options.attitudes);
  if (options.backgrounds.camera) parse_camera(*options.backgrounds.camera);
  require_free(options.dump_views);
  store::StoreTransaction build(options.out);  // before the store is read: nobody else changes it from here on
  if (!options.add && !options.replace) require_no_store(options.out);
  Contents old;
  if (options.add) {
    old = read_contents(options.out);
    stored_quality(old.list, QualitySettings{});  // of other terms: refused before anything is taught, not by hs-pose
  }
  std::vector<TaughtMesh> meshes = options.shown;
  if (meshes.empty() || !options.meshes.sources.empty()) {
    std::vector<TaughtMesh> read = read_meshes(options.meshes);
    std::move(read.begin(), read.end(), std::back_inserter(meshes));
  }
  require_new(old.list, meshes);
  give_ids(old.list, meshes);
  progress(fmt::format("{} meshes read", meshes.size()));

  ObjectStore made = start_store(build.folder());
  std::vector<NamedModel> models;
  keep(old, "", made, models);
  std::vector<TrainingView> views = read_backgrounds(options.backgrounds);
  progress(fmt::format("{} pictures of rooms read", views.size()));
  std::vector<TrainingView> of_objects = make_views(meshes, options, made, progress);
  std::move(of_objects.begin(), of_objects.end(), std::back_inserter(views));
  Forest forest = train_store_forest(std::move(views), old.forest, options, progress);
  take_ids(made, forest);
  std::set<int> new_ids;
  for (NamedModel& model : models_of(meshes)) {
    new_ids.insert(model.object_id);
    models.push_back(std::move(model));
  }
  CalibrationSettings calibration = options.calibration;
  calibration.seed = options.seed;
  calibration.threads = options.threads;
  progress(calibration_step(calibration, new_ids.size()));
  const Practice practice = calibrate_all(models, new_ids, calibration, forest, made);
  progress("scores and qualities learnt");
  made.settings = {{"attitudes", options.attitudes}, {"seed", options.seed}, {"profile", forest.profile}};
  write_store(made, models, forest);
  stop.release();
  build.commit();
  name_lookalikes(models);
  fmt::print("{}", teaching_summary(store::read_store(options.out), new_ids, practice));
  fmt::print("teach_seconds {:.1f}\n", progress.seconds());
}

void remove_from_store(const fs::path& folder, const std::string& name) {
  require_store(folder);
  store::StoreTransaction build(folder);
  const Contents old = read_contents(folder);
  require(old.list.objects.size() > 1 || store::find_object(old.list, name).name != name,
          "{}: '{}' is its only object, expected another one to stay; hs-teach mesh MESH --out {} --replace teaches "
          "others in its place, rm -r {} removes the store",
          folder.string(), name, folder.string(), folder.string());
  const Forest forest = training::remove_object(*old.forest, store::find_object(old.list, name).name);
  ObjectStore made = start_store(build.folder());
  made.settings = old.list.settings;
  std::vector<NamedModel> models;
  keep(old, name, made, models);
  write_store(made, models, forest);
  build.commit();
}

void calibrate_store(const fs::path& folder, const CalibrationSettings& settings,
                     const std::vector<std::string>& names) {
  const Progress progress;
  StopNotice stop(unchanged_notice(folder));
  require_store(folder);
  store::StoreTransaction build(folder);
  const Contents old = read_contents(folder);
  const std::set<int> ids = ids_of(old.list, names);
  ObjectStore made = start_store(build.folder());
  made.settings = old.list.settings;
  std::vector<NamedModel> models;
  keep(old, "", made, models);
  Forest forest = *old.forest;
  progress(calibration_step(settings, ids.size()));
  const Practice practice = calibrate_all(models, ids, settings, forest, made);
  write_store(made, models, forest);
  stop.release();
  build.commit();
  progress("scores and qualities learnt");
  fmt::print("{}", teaching_summary(store::read_store(folder), ids, practice));
}

}  // namespace houghstream::teach
