#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace houghstream::household {

/// Furnished rooms in which scanned objects stand, to measure stores of many objects with.
struct SceneSettings {
  std::filesystem::path models;  ///< BOP models folder
  std::vector<std::string> ids;  ///< ids of its objects that stand in the rooms; empty = all
  std::filesystem::path out;     ///< folder to write to
  int rooms = 8;
  int frames = 5;        ///< frames of a room, from different sides and distances
  int min_objects = 10;  ///< range of the number of objects that a room is meant to hold
  int max_objects = 25;
  std::uint64_t seed = 1;
  int threads = 2;
};

/// Returns for each room the places (0 to `object_count` - 1) of its objects: between `min_objects` and `max_objects`
/// of them, none twice. They are dealt from shuffled decks of all objects, so that over all rooms each comes about as
/// often as any other. The same arguments give the same rooms.
std::vector<std::vector<int>> deal_objects(int object_count, const SceneSettings& settings);

/// Renders OUT/00000N, from 1, for each room, with truth, masks and names.json; a room may lack some of its objects,
/// for which its table had no space. One camera sees all rooms, and each object has the shape of its mesh. The rooms
/// have seeds that neither teaching nor tests use. The same settings give the same files for any number of threads.
/// Throws InputError for meshes that cannot be taught, for fewer objects than `min_objects`, and where images exist
/// already.
void render_scenes(const SceneSettings& settings);

}  // namespace houghstream::household
