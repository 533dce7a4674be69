#pragma once

#include <array>
#include <string>

#include "tools/render/world/objects/seeds.hpp"
#include "tools/render/world/optics/light.hpp"
#include "tools/render/world/rooms/room.hpp"
#include "tools/render/world/trajectory.hpp"

namespace houghstream::world {

/// Describes a furnished, cluttered world and the camera's way through it.
struct Scene {
  std::string name;
  std::uint64_t seed = 0;  ///< see world_seed()
  World world;
  Trajectory trajectory;
};

/// Further classes (ids 101-116) that stand beside the four.
enum class FurtherClasses : std::uint8_t { kNone, kOddIds, kEvenIds };

/// Placement of the taught objects.
enum class ObjectPlacement : std::uint8_t {
  kStanding,  ///< once each
  kLying,     ///< twice: once lying and once on a wedge; their like lie too
  kTilted,    ///< three times: standing, lying, and leaning on a block at 10 to 60 degrees; their like stand or lie
  kHeld       ///< twice: in a hand in any attitude, and standing or lying
};

/// Objects on the table.
struct Clutter {
  bool taught_objects = false;                     ///< the four classes, once each
  int hard_negatives = 0;                          ///< number of second instances (ids 5-8)
  int other_instances = 0;                         ///< never taught, of the kinds of the four (make_other_instance)
  int distractors = 10;                            ///< number of assets tried; those without a free place are left out
  FurtherClasses further = FurtherClasses::kNone;  ///< eight of them, once each
  double taught_colours = 0.0;                     ///< share of the distractors' surfaces that have the four's colours
  ObjectPlacement handling = ObjectPlacement::kStanding;
};

Scene make_scene(const std::string& name, RoomStyle style, const Clutter& clutter, TimeOfDay time, std::uint64_t seed);

/// The six test scenes, after the six of the paper (Section 6).
inline constexpr std::array<const char*, 6> kTestScenes = {"table_small_1", "table_small_2",   "desk_1",
                                                           "desk_2",        "kitchen_small_1", "meeting_small_1"};

/// Scenes to choose settings on, so that the test scenes stay unseen: worlds of training seeds that no training data
/// use.
inline constexpr std::array<const char*, 3> kDevelopmentScenes = {"development_table", "development_desk",
                                                                  "development_kitchen"};

/// Name of further development worlds, with a number from 0 to 999; there are as many as a fit needs.
inline constexpr const char* kDevelopmentWorld = "development_world_";

/// Test scenes of the twenty classes: each holds the four and eight of the sixteen others, in turn one half of them
/// and the other: each of the sixteen is seen on three tables.
inline constexpr std::array<const char*, 6> kTwentyClassScenes = {"objects_20_a", "objects_20_b", "objects_20_c",
                                                                  "objects_20_d", "objects_20_e", "objects_20_f"};

/// Development scenes of the same kind, to choose settings on.
inline constexpr std::array<const char*, 2> kTwentyClassDevelopmentScenes = {"development_objects_20_a",
                                                                             "development_objects_20_b"};

/// Test scenes in which the four classes lie and tilt among lying distractors.
inline constexpr std::array<const char*, 2> kLyingScenes = {"table_lying", "meeting_lying"};

/// Development scenes of the same kind, to choose settings on.
inline constexpr std::array<const char*, 2> kLyingDevelopmentScenes = {"development_lying", "development_lying_2"};

/// Test scenes in which the four classes stand, lie, lean on supports, and are held in hands.
inline constexpr std::array<const char*, 2> kHandledScenes = {"table_tilted", "meeting_held"};

/// Development scenes of the same kind, to choose settings on.
inline constexpr std::array<const char*, 2> kHandledDevelopmentScenes = {"development_tilted", "development_held"};

/// Returns all names, for people.
std::string scene_names();

/// Makes one of the test or development scenes. Throws InputError listing the known names.
Scene make_named_scene(const std::string& name);

/// Makes training room number `index` with clutter of its own and none of the taught objects.
Scene make_background_scene(int index, std::uint64_t seed);

}  // namespace houghstream::world
