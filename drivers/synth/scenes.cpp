#include "drivers/synth/scenes.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/synth/objects.hpp"
#include "drivers/synth/table_layout.hpp"
#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

// Aspects of a world, each with a seed of its own (aspect_seed).
enum Aspect : std::uint64_t { kRoom = 1, kLight, kCameraPath, kLayout, kFirstDistractor };

constexpr int kMonitor = 13;
constexpr int kKeyboard = 9;
constexpr int kBook = 1;

class TableSetter {
 public:
  TableSetter(World& world, const Eigen::Vector2d& table_half, std::uint64_t seed)
      : world_(world), half_(table_half.cwiseMin(Eigen::Vector2d(0.62, 0.5))), layout_(table_half), random_(seed) {}

  bool stand(const ThingPtr& thing, const Eigen::AlignedBox2d& region, double turn_rad, int object_id) {
    const auto T_world_object = layout_.place(*thing, region, turn_rad, random_);
    if (T_world_object) world_.items.push_back({thing, *T_world_object, object_id, true});
    return T_world_object.has_value();
  }

  // Part of the surface, in shares of its half extent.
  Eigen::AlignedBox2d region(double x_low, double x_high, double y_low, double y_high) const {
    return {Eigen::Vector2d(x_low * half_.x(), y_low * half_.y()),
            Eigen::Vector2d(x_high * half_.x(), y_high * half_.y())};
  }

  void stand_object(int id) {
    const TaughtObject object = make_taught_object(id);
    const int truth_id = id <= kClassCount ? id : 0;  // the truth does not name look-alikes
    require(stand(object.thing, region(-0.62, 0.62, -0.75, 0.6), M_PI, truth_id), "scene: no place left for {}",
            object.name);
  }

  Random& random() { return random_; }

 private:
  World& world_;
  Eigen::Vector2d half_;
  TableLayout layout_;
  Random random_;
};

void add_distractors(TableSetter& setter, RoomStyle style, int count, std::uint64_t seed) {
  for (int i = 0; i < count; ++i) {
    int kind = setter.random().below(kDistractorKinds);
    if (kind == kMonitor && style != RoomStyle::kDesk) kind = kBook;
    const ThingPtr thing = make_distractor(kind, aspect_seed(seed, kFirstDistractor + static_cast<std::uint64_t>(i)));
    // Large things stand at the back, as people put them.
    const bool large = kind == kMonitor || thing->mesh.vertices.empty() || thing->name == "lamp";
    const double front = large ? 0.3 : -0.98;
    setter.stand(thing, setter.region(-1.0, 1.0, front, 0.98), kind == kKeyboard || kind == kMonitor ? 0.4 : M_PI, 0);
  }
}

}  // namespace

Scene make_scene(const std::string& name, RoomStyle style, const Clutter& clutter, std::uint64_t seed) {
  Scene scene{name, seed, {}, make_trajectory(aspect_seed(seed, kCameraPath))};
  Room room = make_room(style, aspect_seed(seed, kRoom));
  scene.world.items = std::move(room.items);
  set_light_and_photo(scene.world, aspect_seed(seed, kLight));
  TableSetter setter(scene.world, room.table_half, aspect_seed(seed, kLayout));
  if (style == RoomStyle::kDesk)
    setter.stand(make_distractor(kMonitor, aspect_seed(seed, kFirstDistractor + 500)),
                 setter.region(-0.4, 0.4, 0.4, 0.9), 0.3, 0);
  for (int id = 1; clutter.taught_objects && id <= kClassCount; ++id) setter.stand_object(id);
  const int first = setter.random().below(kClassCount);
  for (int i = 0; i < clutter.look_alikes; ++i) setter.stand_object(kClassCount + 1 + (first + i) % kClassCount);
  add_distractors(setter, style, clutter.distractors, seed);
  return scene;
}

Scene make_named_scene(const std::string& name) {
  struct Plan {
    const char* name;
    RoomStyle style;
    Clutter clutter;
  };
  constexpr std::array<Plan, kTestScenes.size()> kTests = {{{kTestScenes[0], RoomStyle::kTable, {true, 1, 14}},
                                                            {kTestScenes[1], RoomStyle::kTable, {true, 2, 16}},
                                                            {kTestScenes[2], RoomStyle::kDesk, {true, 1, 14}},
                                                            {kTestScenes[3], RoomStyle::kDesk, {true, 2, 18}},
                                                            {kTestScenes[4], RoomStyle::kKitchen, {true, 1, 20}},
                                                            {kTestScenes[5], RoomStyle::kMeeting, {true, 1, 16}}}};
  constexpr std::array<Plan, kDevelopmentScenes.size()> kDevelopment = {
      {{kDevelopmentScenes[0], RoomStyle::kTable, {true, 2, 16}},
       {kDevelopmentScenes[1], RoomStyle::kDesk, {true, 1, 16}},
       {kDevelopmentScenes[2], RoomStyle::kKitchen, {true, 1, 18}}}};
  constexpr std::uint64_t kFirstDevelopmentWorld = 1ULL << 40U;  // far beyond the numbers of training data
  const auto make = [](const Plan& plan, WorldUse use, std::uint64_t number) {
    return make_scene(plan.name, plan.style, plan.clutter, world_seed(use, number));
  };
  for (std::size_t i = 0; i < kTests.size(); ++i) {
    if (name == kTests[i].name) return make(kTests[i], WorldUse::kTest, i);
  }
  for (std::size_t i = 0; i < kDevelopment.size(); ++i) {
    if (name == kDevelopment[i].name) return make(kDevelopment[i], WorldUse::kTraining, kFirstDevelopmentWorld + i);
  }
  fail("scene \"{}\": expected one of {}, or for choosing settings {}", name, fmt::join(kTestScenes, ", "),
       fmt::join(kDevelopmentScenes, ", "));
}

Scene make_background_scene(int index, std::uint64_t seed) {
  const std::uint64_t own = world_seed(WorldUse::kTraining, seed * 100000U + static_cast<std::uint64_t>(index));
  const auto style = static_cast<RoomStyle>(index % kRoomStyles);
  return make_scene("background", style, {false, 0, 16}, own);
}

}  // namespace houghstream
