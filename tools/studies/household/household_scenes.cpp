#include "tools/studies/household/household_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "tools/common/progress_line.hpp"
#include "tools/render/world/calibration_scenes.hpp"
#include "tools/teach/mesh/teach_sources.hpp"

namespace houghstream::household {
namespace {

constexpr std::uint64_t kRooms = 0x686F757365ULL;

std::vector<int> shuffled(int count, Random& random) {
  std::vector<int> deck(static_cast<std::size_t>(count));
  std::iota(deck.begin(), deck.end(), 0);
  for (int i = count - 1; i > 0; --i)
    std::swap(deck[static_cast<std::size_t>(i)], deck[static_cast<std::size_t>(random.between(0, i))]);
  return deck;
}

/// Places of objects in the order in which they are dealt: one shuffled deck after another.
class Decks {
 public:
  Decks(int object_count, std::uint64_t seed) : object_count_(object_count), random_(seed) {}

  /// Takes `count` different places. Those that a room has already stay in the deck for the next room.
  std::vector<int> deal(int count) {
    std::vector<int> taken;
    std::vector<int> passed_over;
    while (static_cast<int>(taken.size()) < count) {
      if (deck_.empty()) deck_ = shuffled(object_count_, random_);
      const int place = deck_.back();
      deck_.pop_back();
      const bool is_here = std::find(taken.begin(), taken.end(), place) != taken.end();
      (is_here ? passed_over : taken).push_back(place);
    }
    deck_.insert(deck_.end(), passed_over.begin(), passed_over.end());
    return taken;
  }

  Random& random() { return random_; }

 private:
  int object_count_;
  Random random_;
  std::vector<int> deck_;
};

std::vector<world::CalibrationSceneObject> scene_objects(const std::vector<teach::TaughtMesh>& meshes, int threads) {
  std::vector<world::CalibrationSceneObject> objects(meshes.size());
  parallel_for(threads, static_cast<int>(meshes.size()), [&](int i) {
    const teach::TaughtMesh& mesh = meshes[static_cast<std::size_t>(i)];
    world::CalibrationSceneObject& object = objects[static_cast<std::size_t>(i)];
    object.id = mesh.id;
    object.thing = world::make_taught_thing(mesh.mesh, mesh.coloured);
    object.ups = world::up_directions(mesh.mesh, world::MeshAttitudes::kResting);
    object.has_colour = mesh.coloured;
  });
  return objects;
}

std::filesystem::path scene_folder(const SceneSettings& settings, int room) {
  return settings.out / fmt::format("{:06d}", room + 1);
}

void check(const SceneSettings& settings, std::size_t object_count) {
  require(settings.min_objects <= settings.max_objects, "{} to {} objects in a room, expected the smaller number first",
          settings.min_objects, settings.max_objects);
  require(object_count >= static_cast<std::size_t>(settings.max_objects), "{}: {} objects, expected at least {}",
          settings.models.string(), object_count, settings.max_objects);
  for (int room = 0; room < settings.rooms; ++room) {
    const std::filesystem::path folder = scene_folder(settings, room);
    require(!has_images(folder), "{}: holds pictures already, expected a new folder", folder.string());
  }
}

world::CalibrationSceneSettings world_settings(const SceneSettings& settings, std::size_t object_count) {
  world::CalibrationSceneSettings out;
  out.frames = settings.frames;
  out.min_objects = static_cast<int>(object_count);
  out.max_objects = out.min_objects;
  out.min_reach = 0.6;
  out.max_reach = 0.95;
  out.varies_instances = false;
  out.camera = world::synthetic_camera();
  return out;
}

}  // namespace

std::vector<std::vector<int>> deal_objects(int object_count, const SceneSettings& settings) {
  Decks decks(object_count, settings.seed ^ kRooms);
  std::vector<std::vector<int>> rooms(static_cast<std::size_t>(settings.rooms));
  for (std::vector<int>& room : rooms) {
    const int count = decks.random().between(settings.min_objects, settings.max_objects);
    room = decks.deal(count);
  }
  return rooms;
}

void render_scenes(const SceneSettings& settings) {
  teach::MeshSources sources;
  sources.sources = {settings.models.string()};
  sources.ids = settings.ids;
  const std::vector<teach::TaughtMesh> meshes = teach::read_meshes(sources);
  check(settings, meshes.size());
  std::map<int, std::string> names;
  for (const teach::TaughtMesh& mesh : meshes) names[mesh.id] = mesh.name;
  const std::vector<world::CalibrationSceneObject> objects = scene_objects(meshes, settings.threads);
  const std::vector<std::vector<int>> rooms = deal_objects(static_cast<int>(objects.size()), settings);
  ProgressLine progress("rooms", settings.rooms);
  parallel_for(settings.threads, settings.rooms, [&](int room) {
    std::vector<world::CalibrationSceneObject> there;
    for (const int place : rooms[static_cast<std::size_t>(room)])
      there.push_back(objects[static_cast<std::size_t>(place)]);
    const std::size_t count = there.size();
    const world::CalibrationScenes scenes(std::move(there), settings.seed ^ kRooms, world_settings(settings, count));
    BopWriter writer(scene_folder(settings, room));
    for (const world::RenderedFrame& view : scenes.render(room))
      writer.add(view.frame, view.objects, view.visible_masks);
    writer.finish();
    write_bop_names(names, scene_folder(settings, room) / "names.json");
    progress.add(1.0);
  });
}

}  // namespace houghstream::household
