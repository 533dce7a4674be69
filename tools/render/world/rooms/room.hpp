#pragma once

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {

enum class RoomStyle : std::uint8_t { kTable, kDesk, kKitchen, kMeeting };
inline constexpr int kRoomStyles = 4;

/// Holds a furnished room with a surface for objects.
struct Room {
  std::vector<PlacedAsset> items;
  Eigen::Vector2d table_half = Eigen::Vector2d(0.5, 0.4);  ///< half the extent of the surface in x and y, metres
};

/// Makes walls, floor, table and furniture. The back wall is at +y; the camera's side is -y.
Room make_room(RoomStyle style, std::uint64_t seed);

}  // namespace houghstream::world
