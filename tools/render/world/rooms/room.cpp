#include "tools/render/world/rooms/room.hpp"

#include <cmath>

#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/seeds.hpp"
#include "tools/render/world/rooms/furniture.hpp"

namespace houghstream::world {
namespace {

constexpr double kTableHeight = 0.74;
constexpr double kFrontWall = -3.4;
constexpr double kWallHeight = 2.6;

struct Walls {
  double back = 2.0;  // y
  double side = 2.2;  // +-x
};

Placed place(ThingPtr thing, const Eigen::Vector3d& position, double yaw_rad = 0.0) {
  Placed placed{std::move(thing), Eigen::Isometry3d::Identity(), 0, true};
  placed.T_world_object.translate(position);
  placed.T_world_object.rotate(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  return placed;
}

Walls plan_walls(RoomStyle style, const Eigen::Vector2d& table_half, Random& random) {
  const bool against_wall = style == RoomStyle::kDesk || style == RoomStyle::kKitchen;
  return {against_wall ? table_half.y() + 0.01 : random.uniform(1.3, 2.3), random.uniform(1.7, 2.6)};
}

Eigen::Vector2d plan_table(RoomStyle style, Random& random) {
  switch (style) {
    case RoomStyle::kTable: return {random.uniform(0.5, 0.65), random.uniform(0.4, 0.5)};
    case RoomStyle::kDesk: return {random.uniform(0.65, 0.8), random.uniform(0.38, 0.45)};
    case RoomStyle::kKitchen: return {random.uniform(1.1, 1.5), random.uniform(0.32, 0.38)};
    default: return {random.uniform(0.8, 1.0), random.uniform(0.5, 0.6)};
  }
}

cv::Mat table_top(RoomStyle style, Random& random) {
  const cv::Size size(1024, 768);
  if (style == RoomStyle::kKitchen) return stone(size, random);
  const int kind = random.below(5);
  if (kind == 0)
    return fabric(size, hsv(random.uniform(0, 360), random.uniform(0.05, 0.5), random.uniform(0.5, 0.95)), random);
  if (kind == 1)
    return plain(size, hsv(random.uniform(0, 360), random.uniform(0.0, 0.15), random.uniform(0.55, 0.95)), 0.04,
                 random);
  return wood(size, random);
}

void add_shell(Room& room, RoomStyle style, const Walls& walls, Random& random) {
  const cv::Mat wall = style == RoomStyle::kKitchen ? tiles({1024, 1024}, random) : wallpaper({1024, 1024}, random);
  const int kind = random.below(3);
  const cv::Mat floor = kind == 0   ? wood({1024, 1024}, random)
                        : kind == 1 ? tiles({1024, 1024}, random)
                                    : carpet({1024, 1024}, random);
  const double depth = walls.back - kFrontWall;
  const double middle = 0.5 * (walls.back + kFrontWall);
  const double z = 0.5 * kWallHeight - kTableHeight;
  constexpr double kThick = 0.05;
  const auto add = [&room](const char* name, const Eigen::Vector3d& size, const cv::Mat& texture,
                           const Eigen::Vector3d& position) {
    room.items.push_back(place(make_asset(name, box(size, texture), 0.03F), position));
    room.items.back().casts_shadow = false;
  };
  add("floor", {2 * walls.side, depth, kThick}, floor, {0, middle, -kTableHeight - 0.5 * kThick});
  add("wall", {2 * walls.side, kThick, kWallHeight}, wall, {0, walls.back + 0.5 * kThick, z});
  add("wall", {2 * walls.side, kThick, kWallHeight}, wall, {0, kFrontWall - 0.5 * kThick, z});
  add("wall", {kThick, depth, kWallHeight}, wall, {-walls.side - 0.5 * kThick, middle, z});
  add("wall", {kThick, depth, kWallHeight}, wall, {walls.side + 0.5 * kThick, middle, z});
}

void add_pictures(Room& room, const Walls& walls, Random& random) {
  const auto hang = [&](ThingPtr thing, const Eigen::Vector3d& position, double yaw) {
    room.items.push_back(place(std::move(thing), position, yaw));
    room.items.back().casts_shadow = false;
  };
  double x = -walls.side + 0.5;
  while (x < walls.side - 0.4) {
    if (chance(random, 0.7)) hang(make_picture(random), {x, walls.back - 0.012, random.uniform(0.3, 0.75)}, 0.0);
    x += random.uniform(0.75, 1.2);
  }
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d position(side * (walls.side - 0.02), random.uniform(-1.0, 0.4), 0.55);
    hang(chance(random, 0.5) ? make_window(random) : make_picture(random), position, -side * M_PI / 2);
  }
}

void add_furniture(Room& room, RoomStyle style, const Walls& walls, Random& random) {
  const double floor = -kTableHeight;
  const double free_behind = walls.back - room.table_half.y();
  if (free_behind > 0.7) {
    if (chance(random, 0.75))
      room.items.push_back(place(make_bookshelf(random), {random.uniform(-1.0, 1.0), walls.back - 0.17, floor}));
    const Eigen::Vector3d size(random.uniform(0.8, 1.4), 0.4, random.uniform(0.6, 1.0));
    const double x = (chance(random, 0.5) ? 1.0 : -1.0) * (walls.side - 0.5 * size.x() - 0.02);
    room.items.push_back(place(make_cabinet(size, random), {x, walls.back - 0.22, floor + 0.5 * size.z()}));
  }
  if (free_behind > 0.6 && chance(random, 0.8)) {
    const double x = random.uniform(-0.5, 0.5) * room.table_half.x();
    room.items.push_back(place(make_chair(random), {x, room.table_half.y() + 0.3, floor}, random.uniform(-0.4, 0.4)));
  }
  if (style == RoomStyle::kMeeting) {
    room.items.push_back(place(make_chair(random), {room.table_half.x() + 0.3, 0.1, floor}, -M_PI / 2));
    room.items.push_back(place(make_chair(random), {-room.table_half.x() - 0.3, -0.1, floor}, M_PI / 2));
  }
  if (style == RoomStyle::kKitchen) {
    room.items.push_back(
        place(make_cabinet({2 * room.table_half.x(), 0.34, 0.7}, random), {0, walls.back - 0.18, 1.0}));
    room.items.push_back(place(make_cabinet({1.9 * room.table_half.x(), 0.5, 0.68}, random), {0, 0.05, floor + 0.345}));
  }
  room.items.push_back(place(make_bin(random), {room.table_half.x() + 0.35, walls.back - 0.3, floor + 0.16}));
}

}  // namespace

Room make_room(RoomStyle style, std::uint64_t seed) {
  Random random(seed);
  Room room;
  room.table_half = plan_table(style, random);
  const Walls walls = plan_walls(style, room.table_half, random);
  add_shell(room, style, walls, random);
  room.items.push_back(place(make_table(room.table_half, kTableHeight, table_top(style, random), random), {0, 0, 0}));
  if (style != RoomStyle::kKitchen) add_pictures(room, walls, random);
  add_furniture(room, style, walls, random);
  return room;
}

}  // namespace houghstream::world
