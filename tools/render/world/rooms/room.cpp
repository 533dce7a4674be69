#include "tools/render/world/rooms/room.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/seeds.hpp"
#include "tools/render/world/objects/vessels.hpp"
#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {
namespace {

// Furniture consists of assets whose origin is on the floor (or wall) in the middle, front to -y. Lengths are in
// metres.

cv::Scalar paint(Random& random) {
  return hsv(random.uniform(0, 360), random.uniform(0.0, 0.5), random.uniform(0.15, 0.9));
}

cv::Mat wood_or_paint(Random& random) {
  return chance(random, 0.6) ? wood({512, 256}, random) : plain({512, 256}, paint(random), 0.06, random);
}

AssetPtr from_parts(const char* name, const std::vector<Part>& parts, float specular, float emission = 0.0F) {
  return make_asset(name, compose(parts), specular, emission);
}

/// The top is at z = 0.
AssetPtr make_table(const Eigen::Vector2d& half, double height, const cv::Mat& top, Random& random) {
  constexpr double kThickness = 0.03;
  const cv::Mat frame = wood_or_paint(random);
  BoxFaces faces;
  faces.top = top;
  faces.front = frame;
  std::vector<Part> parts = {at(box({2 * half.x(), 2 * half.y(), kThickness}, faces), {0, 0, -0.5 * kThickness})};
  const double leg = height - kThickness;
  for (const double x : {-0.92, 0.92}) {
    for (const double y : {-0.88, 0.88}) {
      parts.push_back(at(box({0.045, 0.045, leg}, frame), {x * half.x(), y * half.y(), -kThickness - 0.5 * leg}));
    }
  }
  return from_parts("table", parts, 0.12F);
}

AssetPtr make_chair(Random& random) {
  const cv::Mat frame = wood_or_paint(random);
  const cv::Mat seat = fabric({256, 256}, paint(random), random);
  std::vector<Part> parts = {at(box({0.44, 0.42, 0.05}, seat), {0, 0, 0.45}),
                             at(box({0.42, 0.04, 0.36}, seat), {0, 0.19, 0.8})};
  for (const double x : {-0.19, 0.19}) {
    parts.push_back(at(box({0.03, 0.03, 0.43}, frame), {x, -0.18, 0.215}));
    parts.push_back(at(box({0.03, 0.03, 0.95}, frame), {x, 0.2, 0.475}));
  }
  return from_parts("chair", parts, 0.1F);
}

AssetPtr make_bookshelf(Random& random) {
  const cv::Mat board = wood_or_paint(random);
  const double width = random.uniform(0.7, 1.1);
  constexpr double kDepth = 0.28;
  constexpr int kRows = 5;
  constexpr double kRowHeight = 0.34;
  std::vector<Part> parts = {
      at(box({width, 0.015, kRows * kRowHeight}, board), {0, 0.5 * kDepth, 0.5 * kRows * kRowHeight})};
  for (const double side : {-0.5, 0.5})
    parts.push_back(at(box({0.02, kDepth, kRows * kRowHeight}, board), {side * width, 0, 0.5 * kRows * kRowHeight}));
  std::vector<cv::Mat> spines;
  constexpr int kSpines = 10;
  spines.reserve(kSpines);
  for (int i = 0; i < kSpines; ++i) spines.push_back(carton_side({64, 256}, random_palette(random), random));
  for (int row = 0; row < kRows; ++row) {
    parts.push_back(at(box({width, kDepth, 0.02}, board), {0, 0, row * kRowHeight}));
    double x = -0.5 * width + 0.03;
    while (x < 0.5 * width - 0.08) {
      const double thickness = random.uniform(0.015, 0.055);
      const double tall = random.uniform(0.19, 0.29);
      if (chance(random, 0.85))
        parts.push_back(at(box({thickness, 0.18, tall}, pick(random, spines)),
                           {x + 0.5 * thickness, -0.02, row * kRowHeight + 0.01 + 0.5 * tall}));
      x += thickness + 0.002;
    }
  }
  return from_parts("bookshelf", parts, 0.05F);
}

/// Makes a cabinet with doors and handles; the origin is at its centre.
AssetPtr make_cabinet(const Eigen::Vector3d& size, Random& random) {
  const cv::Mat side = wood_or_paint(random);
  cv::Mat door;
  cv::resize(side, door, {512, 512});
  const int doors = std::max(1, static_cast<int>(std::lround(size.x() / 0.45)));
  const int step = door.cols / doors;
  for (int i = 0; i < doors; ++i) {
    cv::rectangle(door, {i * step + 3, 4, step - 6, door.rows - 8}, {30, 30, 30}, 2);
    const int x = i * step + step * (i % 2 == 0 ? 8 : 2) / 10;
    cv::line(door, {x, door.rows * 2 / 5}, {x, door.rows * 3 / 5}, {190, 195, 200}, std::max(3, step / 40));
  }
  BoxFaces faces;
  faces.front = door;
  faces.back = faces.left = faces.right = faces.top = faces.bottom = side;
  return make_asset("cabinet", box(size, faces), 0.12F);
}

/// Makes a poster to hang; the origin is at its centre.
AssetPtr make_wall_image(Random& random) {
  const double width = random.uniform(0.3, 0.7);
  const double height = random.uniform(0.3, 0.8);
  BoxFaces faces;
  faces.front = poster({static_cast<int>(600 * width), static_cast<int>(600 * height)}, random);
  faces.top = faces.left = faces.right = faces.bottom = faces.back = plain({32, 32}, paint(random), 0.05, random);
  return make_asset("picture", box({width, 0.02, height}, faces), 0.08F);
}

/// Makes a bright window with a frame; the origin is at its centre.
AssetPtr make_window(Random& random) {
  const double width = random.uniform(0.8, 1.4);
  const double height = random.uniform(0.8, 1.2);
  cv::Mat view = plain({256, 256}, {250, 240, 228}, 0.12, random);
  const int blinds = random.below(3) == 0 ? 24 : 0;
  for (int i = 0; i < blinds; ++i) cv::line(view, {0, i * 256 / blinds}, {256, i * 256 / blinds}, {170, 170, 165}, 4);
  cv::line(view, {128, 0}, {128, 256}, {120, 120, 120}, 8);
  cv::rectangle(view, {0, 0, 256, 256}, {120, 120, 120}, 14);
  return make_asset("window", box({width, 0.03, height}, view), 0.1F, 0.95F);
}

AssetPtr make_bin(Random& random) {
  return make_asset("bin", cup_mesh({0.14, 0.11, 0.32, 0.006}, plain({128, 128}, paint(random), 0.06, random)), 0.1F);
}

constexpr double kTableHeight = 0.74;
constexpr double kFrontWall = -3.4;
constexpr double kWallHeight = 2.6;

struct Walls {
  double back = 2.0;  // y
  double side = 2.2;  // +-x
};

PlacedAsset place(AssetPtr thing, const Eigen::Vector3d& position, double yaw_rad = 0.0) {
  PlacedAsset placed{std::move(thing), Eigen::Isometry3d::Identity(), 0, true};
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

void add_wall_images(Room& room, const Walls& walls, Random& random) {
  const auto hang = [&](AssetPtr thing, const Eigen::Vector3d& position, double yaw) {
    room.items.push_back(place(std::move(thing), position, yaw));
    room.items.back().casts_shadow = false;
  };
  double x = -walls.side + 0.5;
  while (x < walls.side - 0.4) {
    if (chance(random, 0.7)) hang(make_wall_image(random), {x, walls.back - 0.012, random.uniform(0.3, 0.75)}, 0.0);
    x += random.uniform(0.75, 1.2);
  }
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d position(side * (walls.side - 0.02), random.uniform(-1.0, 0.4), 0.55);
    hang(chance(random, 0.5) ? make_window(random) : make_wall_image(random), position, -side * M_PI / 2);
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
  if (style != RoomStyle::kKitchen) add_wall_images(room, walls, random);
  add_furniture(room, style, walls, random);
  return room;
}

}  // namespace houghstream::world
