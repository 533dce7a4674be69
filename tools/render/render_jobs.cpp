#include "tools/render/render_jobs.hpp"

#include <algorithm>
#include <optional>

#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/render/ordered_frames.hpp"

namespace houghstream::render {

using namespace world;

namespace {

constexpr int kMaxFrames = 100000;
constexpr int kFramesPerScene = 5;

std::vector<int> object_ids(const std::vector<std::string>& names) {
  if (names == std::vector<std::string>{"all_40"}) return forty_object_ids();
  std::vector<int> ids = twenty_class_ids();
  if (names == std::vector<std::string>{"all_20"}) return ids;
  ids.resize(kClassCount);
  if (names == std::vector<std::string>{"all"}) return ids;
  ids.resize(names.size());
  std::transform(names.begin(), names.end(), ids.begin(), taught_object_id);
  return ids;
}

std::vector<TaughtObject> taught_objects(const std::vector<int>& ids) {
  std::vector<TaughtObject> objects(ids.size());
  std::transform(ids.begin(), ids.end(), objects.begin(), make_taught_object);
  return objects;
}

// Returns the demo's classes, or all twenty where the scene holds one of the others.
std::vector<int> classes_of(const Scene& scene) {
  const auto& items = scene.world.items;
  const bool further = std::any_of(items.begin(), items.end(),
                                   [](const PlacedAsset& item) { return item.object_id >= kFirstFurtherId; });
  return object_ids({further ? "all_20" : "all"});
}

/// Returns the known symmetries of its shape; the finished mesh has its origin on the axis.
Symmetries symmetries_of(const TaughtObject& object) {
  Symmetries symmetries;
  if (object.symmetric_about_z) symmetries.continuous = {{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()}};
  return symmetries;
}

}  // namespace

void write_models(const RenderOptions& options, const std::vector<TaughtObject>& objects) {
  const std::filesystem::path folder = options.out / "models";
  require(options.replace || !has_models(folder), "{}: holds models already; --replace puts others in their place",
          folder.string());
  std::vector<NamedModel> models;
  models.reserve(objects.size());
  for (const TaughtObject& object : objects)
    models.push_back({object.id, object.name, object.thing->mesh, symmetries_of(object)});
  write_bop_models(models, folder);
}

std::filesystem::path fresh_scene(const RenderOptions& options, const std::filesystem::path& folder) {
  require(options.replace || !has_images(folder), "{}: holds pictures already; --replace puts others in their place",
          folder.string());
  remove_images(folder);
  return folder;
}

void render_training(const RenderOptions& options, const std::vector<std::string>& objects,
                     const TurntableSettings& turntable) {
  const std::vector<TaughtObject> taught = taught_objects(object_ids(objects));
  const TurntableWorld table(turntable, options.seed);
  const bool all_upright = turntable.attitudes == std::vector<Attitude>{Attitude::kUpright};
  const auto folder_of = [&](const TaughtObject& object) { return options.out / fmt::format("{:06d}", object.id); };
  for (const TaughtObject& object : taught) fresh_scene(options, folder_of(object));
  write_models(options, taught);
  for (const TaughtObject& object : taught) {
    std::optional<AttitudeChoice> choice;
    if (!all_upright) choice.emplace(object.thing->mesh);
    BopWriter writer(folder_of(object));
    const AttitudeChoice* attitudes = choice ? &*choice : nullptr;
    render_in_order(
        object.name, options.threads, table.view_count(attitudes),
        [&](int index) { return table.render(object, attitudes, index); },
        [&](const RenderedFrame& view) { writer.add(view.frame, view.objects, view.visible_masks); });
    writer.finish();
  }
}

void render_background(const RenderOptions& options, int count) {
  require(count >= 1 && count <= kMaxFrames, "background: {} frames, expected 1 to {}", count, kMaxFrames);
  BopWriter writer(fresh_scene(options, options.out));
  const int rooms = (count + kFramesPerScene - 1) / kFramesPerScene;
  for (int room = 0; room < rooms; ++room) {
    const int here = std::min(kFramesPerScene, count - room * kFramesPerScene);
    const Scene scene = make_background_scene(room, options.seed);
    const LitWorld lit_world = light_world(scene.world);
    render_in_order(
        fmt::format("background room {}/{}", room + 1, rooms), options.threads, here,
        [&](int index) { return render_scene_frame(scene, lit_world, index, kFramesPerScene); },
        [&](const RenderedFrame& view) { writer.add(view.frame, {}, {}); });
  }
  writer.finish();
}

void render_scene(const RenderOptions& options, const SceneJob& job) {
  require(job.frames >= 1 && job.frames <= kMaxFrames, "scene: {} frames, expected 1 to {}", job.frames, kMaxFrames);
  require(job.every >= 1, "scene: every {}th frame, expected at least 1", job.every);
  const Scene scene = make_named_scene(job.name);
  fresh_scene(options, options.out);
  write_models(options, taught_objects(classes_of(scene)));
  const LitWorld lit_world = light_world(scene.world);
  BopWriter writer(options.out);
  render_in_order(
      job.name, options.threads, (job.frames + job.every - 1) / job.every,
      [&](int index) { return render_scene_frame(scene, lit_world, index * job.every, job.frames, job.sensor); },
      [&](const RenderedFrame& view) { writer.add(view.frame, view.objects, view.visible_masks); });
  writer.finish();
}

}  // namespace houghstream::render
