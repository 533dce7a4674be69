#include "tools/teach/mesh/teach_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <set>

#include "detector/training/object_removal.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "drivers/store/object_store.hpp"
#include "drivers/store/store_transaction.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/parallel.hpp"
#include "tools/finder/stored_quality.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"
#include "tools/teach/mesh/lookalikes.hpp"
#include "tools/teach/mesh/stop_notice.hpp"
#include "tools/teach/mesh/store_contents.hpp"
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

/// Assigns ids. Those of BOP folders are kept where they are free; an object without an id, or with one that is taken,
/// gets the smallest free one.
void assign_free_ids(const ObjectStore& old, std::vector<TaughtMesh>& meshes) {
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

void require_new_names(const ObjectStore& old, const std::vector<TaughtMesh>& meshes) {
  for (const TaughtMesh& mesh : meshes) {
    const bool is_known = std::any_of(old.objects.begin(), old.objects.end(),
                                      [&](const StoredObject& object) { return object.name == mesh.name; });
    require(!is_known, "{}: the store {} has a '{}' already, expected a new name (--names), or hs-teach remove first",
            mesh.file.string(), old.folder.string(), mesh.name);
  }
}

/// Searches the objects of the finished store in synthetic scenes, and writes the scores and qualities that the new
/// ones learn there into their groups' forests and the store.
void calibrate_all(const std::vector<StoreModel>& models, const std::set<int>& new_ids,
                   const CalibrationSettings& settings, std::vector<GroupForest>& groups, ObjectStore& new_store) {
  std::vector<CalibrationObject> objects(models.size());
  parallel_for(settings.threads, static_cast<int>(models.size()), [&](int i) {
    const NamedModel& model = models[static_cast<std::size_t>(i)].model;
    const auto of_model = [&](const StoredObject& object) { return object.id == model.object_id; };
    const StoredObject& stored = *std::find_if(new_store.objects.begin(), new_store.objects.end(), of_model);
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
  std::vector<Forest> forests;
  for (GroupForest& it : groups) {
    forests.push_back(std::move(it.forest));
    if (!new_objects_of(forests.back(), new_ids).empty()) it.file.clear();
  }
  const std::map<std::string, CalibratedObject> learnt = calibrate_on_scenes(objects, new_ids, settings, forests);
  for (std::size_t i = 0; i < groups.size(); ++i) groups[i].forest = std::move(forests[i]);
  for (StoredObject& object : new_store.objects) {
    const auto found = learnt.find(object.name);
    if (found == learnt.end()) continue;
    object.quality = quality_to_json(found->second.quality);
    object.practice = found->second.practice;
  }
}

std::string unchanged_notice(const fs::path& folder) {
  return fmt::format("hs-teach: stopped; {}",
                     fs::exists(folder) ? folder.string() + " is as it was" : "nothing was made in " + folder.string());
}

std::string calibration_step(const CalibrationSettings& settings, const std::set<int>& new_ids,
                             const std::vector<GroupForest>& groups) {
  int scenes = 0;
  for (const GroupForest& it : groups) {
    const std::size_t count = new_objects_of(it.forest, new_ids).size();
    if (count > 0) scenes += scene_count_for(count, settings);
  }
  return fmt::format("looked for in {} rendered rooms, of which scores and qualities are learnt", scenes);
}

/// Objects that are taught together.
struct GroupPlan {
  int joined_group = 0;  ///< number of the group that they join; 0: a new one
  std::vector<TaughtMesh> meshes;
};

/// Plans the groups of new objects: all of them join the last group where it has capacity for them; else they form new
/// groups of about the same size.
std::vector<GroupPlan> plan_groups(std::vector<TaughtMesh> meshes, const ObjectStore& old, int max_objects) {
  const auto capacity = static_cast<std::size_t>(max_objects);
  if (!old.objects.empty()) {
    const int last = old.groups().back();
    const auto known = std::count_if(old.objects.begin(), old.objects.end(),
                                     [&](const StoredObject& object) { return object.group == last; });
    if (static_cast<std::size_t>(known) + meshes.size() <= capacity) return {{last, std::move(meshes)}};
  }
  const std::size_t group_count = (meshes.size() + capacity - 1) / capacity;
  std::vector<GroupPlan> plans(group_count);
  for (std::size_t i = 0; i < meshes.size(); ++i)
    plans[i * group_count / meshes.size()].meshes.push_back(std::move(meshes[i]));
  return plans;
}

/// Gives the classes of a forest that was extended the ids of the store.
void assign_store_ids(const ObjectStore& list, Forest& forest) {
  for (ObjectClass& known : forest.classes) known.class_id = store::find_object(list, known.name).id;
}

/// Trains or extends the forest of a group, and adds the group's objects to the store.
void teach_group(const GroupPlan& plan, const TeachOptions& options, const Progress& progress, ObjectStore& new_store,
                 std::vector<GroupForest>& groups) {
  // Views of each group: training changes them.
  std::vector<TrainingView> views = read_backgrounds(options.backgrounds);
  progress(fmt::format("{} pictures of rooms read", views.size()));
  const std::size_t known = new_store.objects.size();
  std::vector<TrainingView> of_objects = make_views(plan.meshes, options, new_store, progress);
  std::move(of_objects.begin(), of_objects.end(), std::back_inserter(views));
  const auto is_joined = [&](const GroupForest& it) { return number_of(it.forest, new_store) == plan.joined_group; };
  const auto old = std::find_if(groups.begin(), groups.end(), is_joined);
  for (std::size_t i = known; i < new_store.objects.size(); ++i)
    new_store.objects[i].group = plan.joined_group > 0 ? plan.joined_group : plan.meshes.front().id;
  if (old == groups.end()) {
    groups.push_back({train_store_forest(std::move(views), nullptr, options, progress), {}});
  } else {
    old->forest = train_store_forest(std::move(views), &old->forest, options, progress);
    old->file.clear();
    assign_store_ids(new_store, old->forest);
  }
}

/// Sorts objects and groups in the order in which read_store() returns them.
void sort_groups(ObjectStore& new_store, std::vector<GroupForest>& groups) {
  store::number_groups(new_store);
  std::stable_sort(groups.begin(), groups.end(), [&](const GroupForest& a, const GroupForest& b) {
    return number_of(a.forest, new_store) < number_of(b.forest, new_store);
  });
}

/// Returns the ids of the names; those of all objects where no names are given.
std::set<int> ids_of(const ObjectStore& list, const std::vector<std::string>& names) {
  std::set<int> ids;
  for (const std::string& name : names) ids.insert(store::find_object(list, name).id);
  if (!names.empty()) return ids;
  for (const StoredObject& object : list.objects) ids.insert(object.id);
  return ids;
}

/// Refuses a folder that is no store.
void require_store(const fs::path& folder) {
  store::recover_store(folder);
  store::read_store(folder);
}

/// Refuses a folder with views of another teaching, which would be taken for this one's.
void require_empty_dump(const fs::path& dump) {
  std::error_code error;
  require(dump.empty() || !fs::exists(dump, error) || (fs::is_directory(dump, error) && fs::is_empty(dump, error)),
          "--dump-views {}: holds something already, expected a new folder or an empty one", dump.string());
}

}  // namespace

void require_no_store(const fs::path& folder) {
  ObjectStore there;
  there.folder = folder;
  if (!fs::exists(there.json_file())) return;
  try {
    there = store::read_store(folder);
  } catch (const InputError& error) {  // a store of another version, for one, that another program may read
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
  require_empty_dump(options.dump_views);
  store::StoreTransaction build(options.out);  // before the store is read: nobody else changes it from here on
  stop.remove_on_stop(build.folder());
  if (!options.add && !options.replace) require_no_store(options.out);
  StoreContents old;
  if (options.add) {
    old = read_contents(options.out);
    stored_quality(old.list, QualitySettings{});  // refuses other terms before anything is taught, not in hs-pose
  }
  std::vector<TaughtMesh> meshes = options.shown;
  if (meshes.empty() || !options.meshes.sources.empty()) {
    std::vector<TaughtMesh> read = read_meshes(options.meshes);
    std::move(read.begin(), read.end(), std::back_inserter(meshes));
  }
  require_new_names(old.list, meshes);
  assign_free_ids(old.list, meshes);
  progress(fmt::format("{} mesh{} read", meshes.size(), meshes.size() == 1 ? "" : "es"));

  ObjectStore new_store = start_store(build.folder());
  std::vector<StoreModel> models;
  copy_objects(old, "", new_store, models);
  if (!options.dump_views.empty()) write_bop_models(models_of(meshes), options.dump_views / "models");
  std::set<int> new_ids;
  for (NamedModel& model : models_of(meshes)) {
    new_ids.insert(model.object_id);
    models.push_back({std::move(model), {}});
  }
  std::vector<GroupForest>& groups = old.groups;
  for (const GroupPlan& plan : plan_groups(std::move(meshes), old.list, options.max_group_objects))
    teach_group(plan, options, progress, new_store, groups);
  sort_groups(new_store, groups);
  CalibrationSettings calibration = options.calibration;
  calibration.seed = options.seed;
  calibration.threads = options.threads;
  progress(calibration_step(calibration, new_ids, groups));
  calibrate_all(models, new_ids, calibration, groups, new_store);
  progress("scores and qualities learnt");
  new_store.settings = {
      {"attitudes", options.attitudes}, {"seed", options.seed}, {"profile", groups.front().forest.profile}};
  write_store(new_store, models, groups);
  stop.release();
  build.commit();
  log_lookalikes(models, new_store);
  fmt::print("teach_seconds {:.1f}\n", progress.seconds());
  fmt::print("{}", teaching_summary(store::read_store(options.out), new_ids));
}

void log_lookalikes(const std::vector<StoreModel>& models, const ObjectStore& list) {
  std::vector<NamedMesh> named;
  named.reserve(models.size());
  for (const StoreModel& it : models) named.emplace_back(it.model.name, &it.model.mesh);
  for (const Lookalike& pair : find_lookalikes(named)) log_warning("{}", describe(pair));
  for (const std::string& line : confusion_lines(list)) log_warning("{}", line);
}

void remove_from_store(const fs::path& folder, const std::string& name) {
  require_store(folder);
  store::StoreTransaction build(folder);
  StoreContents old = read_contents(folder);
  require(old.list.objects.size() > 1 || store::find_object(old.list, name).name != name,
          "{}: '{}' is its only object, expected another one to stay; hs-teach mesh MESH --out {} --replace teaches "
          "others in its place, rm -r {} removes the store",
          folder.string(), name, folder.string(), folder.string());
  const int group = store::find_object(old.list, name).group;
  std::vector<GroupForest>& groups = old.groups;
  const auto of_object = std::find_if(groups.begin(), groups.end(),
                                      [&](const GroupForest& it) { return number_of(it.forest, old.list) == group; });
  if (groups.size() > 1 && of_object->forest.classes.size() == 1) {
    groups.erase(of_object);
  } else {
    *of_object = {training::remove_object(of_object->forest, name), {}};
  }
  ObjectStore new_store = start_store(build.folder());
  new_store.settings = old.list.settings;
  std::vector<StoreModel> models;
  copy_objects(old, name, new_store, models);
  sort_groups(new_store, groups);
  write_store(new_store, models, groups);
  build.commit();
}

void calibrate_store(const fs::path& folder, const CalibrationSettings& settings,
                     const std::vector<std::string>& names) {
  const Progress progress;
  StopNotice stop(unchanged_notice(folder));
  require_store(folder);
  store::StoreTransaction build(folder);
  stop.remove_on_stop(build.folder());
  StoreContents old = read_contents(folder);
  const std::set<int> ids = ids_of(old.list, names);
  ObjectStore new_store = start_store(build.folder());
  new_store.settings = old.list.settings;
  std::vector<StoreModel> models;
  copy_objects(old, "", new_store, models);
  progress(calibration_step(settings, ids, old.groups));
  calibrate_all(models, ids, settings, old.groups, new_store);
  write_store(new_store, models, old.groups);
  stop.release();
  build.commit();
  progress("scores and qualities learnt");
  log_lookalikes(models, new_store);
  fmt::print("{}", teaching_summary(store::read_store(folder), ids));
}

}  // namespace houghstream::teach
