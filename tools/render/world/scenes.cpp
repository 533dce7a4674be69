#include "tools/render/world/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/rooms/table_setter.hpp"

namespace houghstream::world {
namespace {

// Aspects of a world, each with a seed of its own (aspect_seed).
enum Aspect : std::uint64_t { kRoom = 1, kLight, kCameraPath, kLayout, kFirstDistractor, kFirstInstance = 1000 };

constexpr int kMonitor = 13;
constexpr int kKeyboard = 9;
constexpr int kBook = 1;

// Adds bowls, cartons, mugs and cans that were never taught, as a real kitchen has them.
void add_other_instances(TableSetter& setter, const Clutter& clutter, std::uint64_t seed) {
  const int first = Random(aspect_seed(seed, kFirstInstance - 1)).below(kClassCount);
  const Eigen::AlignedBox2d where = setter.region(-0.95, 0.95, -0.85, 0.95);
  for (int i = 0; i < clutter.other_instances; ++i) {
    const AssetPtr thing = make_other_instance(1 + (first + i) % kClassCount,
                                               aspect_seed(seed, kFirstInstance + static_cast<std::uint64_t>(i)));
    const bool lies =
        clutter.handling == ObjectPlacement::kLying || (clutter.handling == ObjectPlacement::kTilted && i % 2 == 1);
    if (lies)
      setter.put(put_lying(thing, 0, setter.random()), where);
    else
      setter.stand(thing, where, M_PI, 0);
  }
}

void add_distractors(TableSetter& setter, RoomStyle style, const Clutter& clutter, std::uint64_t seed) {
  for (int i = 0; i < clutter.distractors; ++i) {
    int kind = setter.random().below(kDistractorKinds);
    if (kind == kMonitor && style != RoomStyle::kDesk) kind = kBook;
    const std::uint64_t derived_seed = aspect_seed(seed, kFirstDistractor + static_cast<std::uint64_t>(i));
    const AssetPtr thing = make_distractor(kind, derived_seed, clutter.taught_colours);
    // Large assets are at the back, as people put them.
    const bool large = kind == kMonitor || thing->mesh.vertices.empty() || thing->name == "lamp";
    const double front = large ? 0.3 : -0.98;
    setter.stand(thing, setter.region(-1.0, 1.0, front, 0.98), kind == kKeyboard || kind == kMonitor ? 0.4 : M_PI, 0);
  }
}

// Places more objects in a larger region, since twelve need more space than four.
void add_many_objects(TableSetter& setter, FurtherClasses further) {
  const Eigen::AlignedBox2d where = setter.region(-0.75, 0.75, -0.65, 0.85);
  for (const int id : twenty_class_ids()) {
    const bool odd = id % 2 == 1;
    if (id <= kClassCount || odd == (further == FurtherClasses::kOddIds)) setter.stand_object(id, where);
  }
}

// Adds each class once lying and once tilted.
void add_lying_objects(TableSetter& setter, const Eigen::AlignedBox2d& where) {
  for (int id = 1; id <= kClassCount; ++id) {
    setter.tilt_object(id, where);
    setter.lay_object(id, where);
  }
}

// Adds each class leaning, lying and standing; those that need most room come first.
void add_tilted_objects(TableSetter& setter, const Eigen::AlignedBox2d& where) {
  for (int id = 1; id <= kClassCount; ++id) setter.lean_object(id, where);
  for (int id = 1; id <= kClassCount; ++id) setter.lay_object(id, where);
  for (int id = 1; id <= kClassCount; ++id) setter.stand_object(id, where);
}

// Adds each class in a hand, two from the sides and two from behind, and once more on the table.
void add_held_objects(TableSetter& setter, const Trajectory& trajectory) {
  Random& random = setter.random();
  HeldPlace place;
  for (const double time : {0.1, 0.3, 0.5, 0.7, 0.9}) place.views.push_back(camera_at(trajectory, time));
  const int first = random.below(kClassCount);
  for (int i = 0; i < kClassCount; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const bool behind = i >= 2;
    const double x = side * (behind ? 0.35 : 0.65) + random.uniform(-0.08, 0.08);
    const double y = (behind ? 0.45 : -0.45) + random.uniform(-0.1, 0.1);
    place.over = setter.region(x, x, y, y).min();
    const double angle = random.uniform(0.0, 0.5);  // from +x or -x, or from +y, and then outwards
    const double azimuth = behind ? M_PI / 2 - angle : angle;
    place.arm_azimuth_rad = side > 0.0 ? azimuth : M_PI - azimuth;
    setter.hold_object(1 + (first + i) % kClassCount, place);
  }
  const Eigen::AlignedBox2d where = setter.region(-0.8, 0.8, -0.85, 0.8);
  for (int id = 1; id <= kClassCount; ++id) {
    if (chance(random, 0.5))
      setter.lay_object(id, where);
    else
      setter.stand_object(id, where);
  }
}

Eigen::AlignedBox2d place_of_objects(const TableSetter& setter, ObjectPlacement handling) {
  switch (handling) {
    case ObjectPlacement::kLying: return setter.region(-0.75, 0.75, -0.7, 0.75);
    case ObjectPlacement::kTilted:
    case ObjectPlacement::kHeld: return setter.region(-0.85, 0.85, -0.85, 0.85);
    default: return setter.region(-0.62, 0.62, -0.75, 0.6);
  }
}

void add_objects(TableSetter& setter, const Clutter& clutter, const Trajectory& trajectory) {
  const Eigen::AlignedBox2d where = place_of_objects(setter, clutter.handling);
  if (clutter.further != FurtherClasses::kNone) {
    add_many_objects(setter, clutter.further);
  } else if (clutter.handling == ObjectPlacement::kLying) {
    add_lying_objects(setter, where);
  } else if (clutter.handling == ObjectPlacement::kTilted) {
    add_tilted_objects(setter, where);
  } else if (clutter.handling == ObjectPlacement::kHeld) {
    add_held_objects(setter, trajectory);
  } else {
    for (int id = 1; clutter.taught_objects && id <= kClassCount; ++id) setter.stand_object(id, where);
  }
  const int first = setter.random().below(kClassCount);
  for (int i = 0; i < clutter.hard_negatives; ++i) {
    const int id = kClassCount + 1 + (first + i) % kClassCount;
    if (clutter.handling == ObjectPlacement::kLying)
      setter.lay_object(id, where);
    else
      setter.stand_object(id, where);
  }
}

}  // namespace

Scene make_scene(const std::string& name, RoomStyle style, const Clutter& clutter, TimeOfDay time, std::uint64_t seed) {
  Scene scene{name, seed, {}, make_trajectory(aspect_seed(seed, kCameraPath))};
  Room room = make_room(style, aspect_seed(seed, kRoom));
  scene.world.items = std::move(room.items);
  set_lighting(scene.world, time, aspect_seed(seed, kLight));
  TableSetter setter(scene.world, room.table_half, aspect_seed(seed, kLayout));
  if (style == RoomStyle::kDesk)
    setter.stand(make_distractor(kMonitor, aspect_seed(seed, kFirstDistractor + 500)),
                 setter.region(-0.4, 0.4, 0.4, 0.9), 0.3, 0);
  add_objects(setter, clutter, scene.trajectory);
  add_other_instances(setter, clutter, seed);
  add_distractors(setter, style, clutter, seed);
  return scene;
}

namespace {

struct Plan {
  const char* name = "";
  DatasetSplit use = DatasetSplit::kTraining;
  std::uint64_t world = 0;  ///< number for world_seed()
  RoomStyle style = RoomStyle::kTable;
  TimeOfDay time = TimeOfDay::kDay;
  Clutter clutter;
};

constexpr std::uint64_t kDevelopment = 1ULL << 40U;  // first of its worlds, far beyond the numbers of training data
constexpr DatasetSplit kTest = DatasetSplit::kTest;
constexpr DatasetSplit kTraining = DatasetSplit::kTraining;
constexpr TimeOfDay kDay = TimeOfDay::kDay;
constexpr TimeOfDay kEvening = TimeOfDay::kEvening;
constexpr FurtherClasses kNone = FurtherClasses::kNone;
constexpr FurtherClasses kOdd = FurtherClasses::kOddIds;
constexpr FurtherClasses kEven = FurtherClasses::kEvenIds;

// Fraction for tables on which most distractors have the taught objects' colours, so that only shape distinguishes
// them.
constexpr double kAlike = 0.85;

constexpr std::array<Plan, 25> kPlans = {
    {{kTestScenes[0], kTest, 0, RoomStyle::kTable, kDay, {true, 1, 3, 14, kNone, kAlike}},
     {kTestScenes[1], kTest, 1, RoomStyle::kTable, kEvening, {true, 2, 8, 10, kNone, kAlike}},
     {kTestScenes[2], kTest, 2, RoomStyle::kDesk, kDay, {true, 1, 8, 8, kNone, kAlike}},
     {kTestScenes[3], kTest, 3, RoomStyle::kDesk, kEvening, {true, 2, 8, 12, kNone, kAlike}},
     {kTestScenes[4], kTest, 4, RoomStyle::kKitchen, kDay, {true, 1, 8, 14, kNone, kAlike}},
     {kTestScenes[5], kTest, 5, RoomStyle::kMeeting, kEvening, {true, 1, 8, 10, kNone, kAlike}},
     {kTwentyClassScenes[0], kTest, 20, RoomStyle::kTable, kDay, {true, 1, 0, 12, kOdd}},
     {kTwentyClassScenes[1], kTest, 21, RoomStyle::kMeeting, kDay, {true, 1, 0, 14, kEven}},
     {kTwentyClassScenes[2], kTest, 22, RoomStyle::kDesk, kDay, {true, 1, 0, 12, kOdd}},
     {kTwentyClassScenes[3], kTest, 23, RoomStyle::kKitchen, kDay, {true, 1, 0, 14, kEven}},
     {kTwentyClassScenes[4], kTest, 24, RoomStyle::kMeeting, kDay, {true, 1, 0, 12, kOdd}},
     {kTwentyClassScenes[5], kTest, 25, RoomStyle::kTable, kDay, {true, 1, 0, 14, kEven}},
     {kDevelopmentScenes[0], kTraining, kDevelopment, RoomStyle::kTable, kDay, {true, 2, 3, 16, kNone, kAlike}},
     {kDevelopmentScenes[1], kTraining, kDevelopment + 1, RoomStyle::kDesk, kEvening, {true, 1, 8, 10, kNone}},
     {kDevelopmentScenes[2], kTraining, kDevelopment + 2, RoomStyle::kKitchen, kDay, {true, 1, 8, 12, kNone}},
     {kTwentyClassDevelopmentScenes[0],
      kTraining,
      kDevelopment + 20,
      RoomStyle::kMeeting,
      kDay,
      {true, 1, 0, 14, kOdd}},
     {kTwentyClassDevelopmentScenes[1], kTraining, kDevelopment + 21, RoomStyle::kTable, kDay, {true, 1, 0, 12, kEven}},
     {kLyingScenes[0], kTest, 30, RoomStyle::kTable, kDay, {true, 1, 4, 12, kNone, 0.0, ObjectPlacement::kLying}},
     {kLyingScenes[1], kTest, 31, RoomStyle::kMeeting, kEvening, {true, 1, 4, 12, kNone, 0.0, ObjectPlacement::kLying}},
     {kLyingDevelopmentScenes[0],
      kTraining,
      kDevelopment + 30,
      RoomStyle::kTable,
      kDay,
      {true, 1, 4, 12, kNone, 0.0, ObjectPlacement::kLying}},
     {kLyingDevelopmentScenes[1],
      kTraining,
      kDevelopment + 31,
      RoomStyle::kMeeting,
      kEvening,
      {true, 1, 4, 12, kNone, 0.0, ObjectPlacement::kLying}},
     {kHandledScenes[0], kTest, 40, RoomStyle::kTable, kDay, {true, 1, 4, 10, kNone, 0.0, ObjectPlacement::kTilted}},
     {kHandledScenes[1], kTest, 41, RoomStyle::kMeeting, kDay, {true, 1, 4, 10, kNone, 0.0, ObjectPlacement::kHeld}},
     {kHandledDevelopmentScenes[0],
      kTraining,
      kDevelopment + 40,
      RoomStyle::kTable,
      kEvening,
      {true, 1, 4, 10, kNone, 0.0, ObjectPlacement::kTilted}},
     {kHandledDevelopmentScenes[1],
      kTraining,
      kDevelopment + 41,
      RoomStyle::kMeeting,
      kDay,
      {true, 1, 4, 10, kNone, 0.0, ObjectPlacement::kHeld}}}};

/// Returns the number N of "development_world_N", 0 to 999.
std::optional<int> development_number(const std::string& name) {
  const std::string prefix = kDevelopmentWorld;
  const std::string digits = name.substr(std::min(name.size(), prefix.size()));
  const bool numbered = name == prefix + digits && !digits.empty() && digits.size() <= 3 &&
                        digits.find_first_not_of("0123456789") == std::string::npos;
  return numbered ? std::optional<int>(std::stoi(digits)) : std::nullopt;
}

Plan development_plan(int number) {
  constexpr std::uint64_t kFirstWorld = 100;  // after those of kPlans
  Plan plan;
  plan.name = kDevelopmentWorld;
  plan.world = kDevelopment + kFirstWorld + static_cast<std::uint64_t>(number);
  plan.style = static_cast<RoomStyle>(number % kRoomStyles);
  plan.time = number % 3 == 2 ? kEvening : kDay;
  plan.clutter.taught_objects = true;
  plan.clutter.hard_negatives = 1 + number % 2;
  plan.clutter.other_instances = 8;
  plan.clutter.distractors = 8 + 2 * (number % 4);
  plan.clutter.taught_colours = number % 2 == 0 ? kAlike : 0.0;
  return plan;
}

Scene planned_scene(const std::string& name, const Plan& plan) {
  return make_scene(name, plan.style, plan.clutter, plan.time, world_seed(plan.use, plan.world));
}

}  // namespace

std::string scene_names() {
  return fmt::format("{}, {}, {}, {}, or for choosing settings {}, {}, {}, {}, {}0 to {}999",
                     fmt::join(kTestScenes, ", "), fmt::join(kTwentyClassScenes, ", "), fmt::join(kLyingScenes, ", "),
                     fmt::join(kHandledScenes, ", "), fmt::join(kDevelopmentScenes, ", "),
                     fmt::join(kTwentyClassDevelopmentScenes, ", "), fmt::join(kLyingDevelopmentScenes, ", "),
                     fmt::join(kHandledDevelopmentScenes, ", "), kDevelopmentWorld, kDevelopmentWorld);
}

Scene make_named_scene(const std::string& name) {
  for (const Plan& plan : kPlans) {
    if (name == plan.name) return planned_scene(name, plan);
  }
  if (const std::optional<int> number = development_number(name)) return planned_scene(name, development_plan(*number));
  fail("scene \"{}\": expected one of {}", name, scene_names());
}

Scene make_background_scene(int index, std::uint64_t seed) {
  const std::uint64_t derived_seed =
      world_seed(DatasetSplit::kTraining, seed * 100000U + static_cast<std::uint64_t>(index));
  const auto style = static_cast<RoomStyle>(index % kRoomStyles);
  return make_scene("background", style, {false, 0, 0, 16, kNone}, TimeOfDay::kDay, derived_seed);
}

}  // namespace houghstream::world
