#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/render/world/objects/asset.hpp"

// These make the objects. Frame of each: origin at the centre of its bounding box, z up, front to -y.

namespace houghstream::world {

/// Describes an object that can be taught. Ids 1-4 (bowl, cereal_box, coffee_mug, soda_can) are the demo's classes; 5-8
/// are their second instances (bowl_2 ...), of other proportions and textures; 101-116 are sixteen further classes
/// (further_objects.hpp), which with the demo's make twenty; 201-220 are instances of the demo's classes that are
/// taught only to measure how time grows (other_bowl_1, other_carton_2 ...).
struct TaughtObject {
  int id = 0;
  std::string name;
  bool symmetric_about_z = false;  ///< symmetry of its shape; its texture may differ all round
  AssetPtr thing;
};

inline constexpr int kClassCount = 4;         ///< ids 1 to 4
inline constexpr int kTaughtObjectCount = 8;  ///< ids 1 to 8, look-alikes included
inline constexpr int kFirstFurtherId = 101;
inline constexpr int kFurtherClassCount = 16;  ///< ids 101 to 116

inline constexpr int kFirstInstanceId = 201;
inline constexpr int kTaughtInstanceCount = 20;  ///< ids 201 to 220

/// Returns the twenty classes' ids: 1-4 and 101-116.
std::vector<int> twenty_class_ids();

/// Returns these and twenty more: 201-220 behind them.
std::vector<int> forty_object_ids();

/// Makes object `id`, 1 to 8, 101 to 116 or 201 to 220; it is the same on every call. Throws InputError for another id.
TaughtObject make_taught_object(int id);

/// Returns the id of a name: "bowl" -> 1. Throws InputError listing the known names.
int taught_object_id(const std::string& name);

/// Makes an instance of class 1 to 4 that is never taught: of the taught one's colours in another size, or of its size
/// in other colours. Shape and texture follow the seed. Throws InputError for another class.
AssetPtr make_other_instance(int class_id, std::uint64_t seed);

/// Makes household assets that are never taught. `kind` is 0 to kDistractorKinds-1; shape and texture follow the seed.
/// `taught_colours` is the probability that a surface has a colour of the four classes.
inline constexpr int kDistractorKinds = 16;
AssetPtr make_distractor(int kind, std::uint64_t seed, double taught_colours = 0.0);

}  // namespace houghstream::world
