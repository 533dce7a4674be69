#include "tools/render/world/takes/take_stage.hpp"

#include <algorithm>
#include <cmath>

#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/vessels.hpp"
#include "tools/render/world/optics/light.hpp"
#include "tools/render/world/rooms/attitudes.hpp"
#include "tools/render/world/rooms/room.hpp"
#include "tools/render/world/rooms/table_setter.hpp"

namespace houghstream::world {
namespace {

// Aspects of a take's world have seeds of their own (aspect_seed). Those of the room are the same in both takes.
namespace take_aspect {
enum : std::uint64_t { kRoom = 1, kLight, kTable, kFirstThing, kTakeAspects = 1000, kPath, kPlace, kTurning };
}  // namespace take_aspect

constexpr std::uint64_t kFirstTakeWorld = 1ULL << 42U;  // far beyond the numbers of other uses
constexpr double kShadowRadiusM = 0.5;
constexpr double kDiscM = 0.02;  // height of the turntable
constexpr double kTurnRad = 2.0 * M_PI + 0.25;
constexpr int kStrokes = 6;
constexpr double kTallestBesideShownM = 0.13;  // a maximum, so that surrounding assets do not hide the object

// Parts of a stroke: the hand comes, turns the object, goes, and is away.
constexpr double kComeFraction = 0.15;
constexpr double kTurnFraction = 0.6;
constexpr double kGoFraction = 0.15;
constexpr double kHandAwayM = 0.5;

double eased_stroke(double fraction) {
  const double t = std::clamp(fraction, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

Eigen::Isometry3d rotated_about_z(double angle_rad) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()));
}

}  // namespace

std::string take_kind_name(TakeKind kind) {
  switch (kind) {
    case TakeKind::kTurntable: return "turntable";
    case TakeKind::kHandTurns: return "hand_turns";
    default: return "hand_held";
  }
}

TakeStage::TakeStage(const TakePlan& plan)
    : kind_(plan.kind),
      seed_(aspect_seed(world_seed(plan.use, kFirstTakeWorld + plan.number),
                        take_aspect::kTakeAspects + (plan.laid_down ? 200U : 100U))),
      seconds_(plan.seconds) {
  furnish(plan);
  put_object(plan);
  choose_camera(plan);
  if (kind_ == TakeKind::kHandTurns) add_hands();
  move(world_, 0.0);
}

// A table that one can walk round.
void TakeStage::furnish(const TakePlan& plan) {
  const std::uint64_t take_seed = world_seed(plan.use, kFirstTakeWorld + plan.number);
  Random random(aspect_seed(take_seed, take_aspect::kTable));
  Room room = make_room(chance(random, 0.5) ? RoomStyle::kTable : RoomStyle::kMeeting,
                        aspect_seed(take_seed, take_aspect::kRoom));
  world_.items = std::move(room.items);
  set_lighting(world_, plan.number % 4 == 3 ? TimeOfDay::kEvening : TimeOfDay::kDay,
               aspect_seed(take_seed, take_aspect::kLight));
  world_.focus_radius_m = kShadowRadiusM;
  TableSetter setter(world_, room.table_half, aspect_seed(take_seed, take_aspect::kTable));
  for (int i = 0; i < 5; ++i) {
    const AssetPtr thing =
        make_distractor(random.below(kDistractorKinds), aspect_seed(take_seed, take_aspect::kFirstThing + i));
    if (thing_height(*thing) > kTallestBesideShownM) continue;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const double near = std::min(side * 0.6, side * 0.98);
    setter.stand(thing, setter.region(near, near + 0.38, -0.9, 0.9), M_PI, 0);
  }
}

void TakeStage::put_object(const TakePlan& plan) {
  const TaughtObject object = make_taught_object(plan.object_id);
  Random random(aspect_seed(seed_, take_aspect::kPlace));
  PlacedAsset placed{object.thing, Eigen::Isometry3d::Identity(), object.id, true};
  if (plan.laid_down) {
    placed = put_lying(object.thing, object.id, random).front();
  } else {
    placed.T_world_object.translate(Eigen::Vector3d(0.0, 0.0, 0.5 * thing_height(*object.thing)));
  }
  if (kind_ == TakeKind::kTurntable) add_turntable(plan);
  const double aside = kind_ == TakeKind::kTurntable ? 0.01 : 0.03;
  Eigen::Isometry3d T_world_place = Eigen::Isometry3d::Identity();
  T_world_place.translate(Eigen::Vector3d(random.uniform(-aside, aside), random.uniform(-aside, aside),
                                          kind_ == TakeKind::kTurntable ? kDiscM : 0.0));
  T_world_place.rotate(rotated_about_z(random.uniform(-M_PI, M_PI)).linear());
  placed.T_world_object = T_world_place * placed.T_world_object;
  object_ = world_.items.size();
  world_.items.push_back(placed);
}

void TakeStage::add_turntable(const TakePlan& plan) {
  Random random(aspect_seed(world_seed(plan.use, kFirstTakeWorld + plan.number), take_aspect::kTurning));
  const cv::Mat cover = plain({256, 256}, hsv(random.uniform(0, 360), 0.1, random.uniform(0.3, 0.8)), 0.05, random);
  const AssetPtr disc = make_asset("turntable", rotated_mesh({{0.16, 0.0}, {0.16, kDiscM}}, cover), 0.08F);
  turntable_ = world_.items.size();
  world_.items.push_back({disc, Eigen::Isometry3d::Identity(), 0, true});
  world_.items.back().T_world_object.translate(Eigen::Vector3d(0.0, 0.0, 0.5 * kDiscM));
}

void TakeStage::choose_camera(const TakePlan& plan) {
  const PlacedAsset& object = world_.items[object_];
  HandPathSettings settings;
  settings.seconds = plan.seconds;
  settings.angle_rad = kTurnRad;
  settings.target_world = object.T_world_object.translation();
  settings.distance_m = std::clamp(0.43 + 0.9 * mesh_diameter(object.thing->mesh), 0.5, 0.85);
  if (kind_ == TakeKind::kHandHeld) {
    path_.emplace(settings, aspect_seed(seed_, take_aspect::kPath));
    return;
  }
  settings.angle_rad = 0.0;
  T_still_world_ = HandPath(settings, aspect_seed(seed_, take_aspect::kPath)).T_camera_world(0.0);
  if (kind_ == TakeKind::kTurntable) turning_.emplace(plan.seconds, aspect_seed(seed_, take_aspect::kTurning));
}

// Returns the object's pose, rotated about its own position; a turntable rotates about its own middle.
Eigen::Isometry3d TakeStage::object_at(double rotated_rad) const {
  const Eigen::Isometry3d& T_world_object = world_.items[object_].T_world_object;
  Eigen::Vector3d axis = T_world_object.translation();
  if (turntable_) axis = Eigen::Vector3d::Zero();
  return Eigen::Translation3d(axis) * rotated_about_z(rotated_rad) * Eigen::Translation3d(-axis) * T_world_object;
}

void TakeStage::add_hands() {
  const Eigen::Vector3d eye = T_still_world_.inverse().translation();
  HeldPlace place;
  place.views = {T_still_world_};
  for (int i = 0; i < kStrokes; ++i) {
    Stroke stroke;
    stroke.start_s = seconds_ * i / kStrokes;
    stroke.seconds = seconds_ / kStrokes;
    stroke.start_rad = kTurnRad * i / kStrokes;
    PlacedAsset object = world_.items[object_];
    object.T_world_object = object_at(stroke.start_rad);
    // The arm comes from the camera's right, or its left.
    place.arm_azimuth_rad = std::atan2(eye.y(), eye.x()) + (i % 2 == 0 ? 1.2 : -1.2);
    Random random(aspect_seed(seed_, take_aspect::kTurning));  // gives the same skin and sleeve each time
    const PlacedAsset hand = take_hold(object, place, random);
    stroke.T_object_hand = object.T_world_object.inverse() * hand.T_world_object;
    stroke.hand = world_.items.size();
    world_.items.push_back(hand);
    strokes_.push_back(stroke);
  }
}

double TakeStage::rotated_rad(double seconds) const {
  if (turning_) return kTurnRad * turning_->at(seconds);
  double rotated = 0.0;
  for (const Stroke& stroke : strokes_)
    rotated += eased_stroke(((seconds - stroke.start_s) / stroke.seconds - kComeFraction) / kTurnFraction) * kTurnRad /
               kStrokes;
  return rotated;
}

void TakeStage::move_hand(const Stroke& stroke, double seconds, World& world) const {
  const double fraction = (seconds - stroke.start_s) / stroke.seconds;
  const double away = std::max(eased_stroke(1.0 - fraction / kComeFraction),
                               eased_stroke((fraction - kComeFraction - kTurnFraction) / kGoFraction));
  const Eigen::Isometry3d T_world_hand = world.items[object_].T_world_object * stroke.T_object_hand;
  Eigen::Isometry3d& placed = world.items[stroke.hand].T_world_object;
  placed = Eigen::Translation3d(kHandAwayM * away * (T_world_hand.linear().col(0) + Eigen::Vector3d(0.0, 0.0, 0.3))) *
           T_world_hand;
  // Out of everybody's sight when it is away.
  if (away >= 1.0) placed.translation() = Eigen::Vector3d(0.0, 0.0, -50.0);
}

Eigen::Isometry3d TakeStage::move(World& world, double seconds) const {
  if (path_) return path_->T_camera_world(seconds);
  const double rotated = rotated_rad(seconds);
  world.items[object_].T_world_object = object_at(rotated);
  if (turntable_)
    world.items[*turntable_].T_world_object = rotated_about_z(rotated) * world_.items[*turntable_].T_world_object;
  for (const Stroke& stroke : strokes_) move_hand(stroke, seconds, world);
  return T_still_world_;
}

}  // namespace houghstream::world
