#include "tools/render/world/sequences/sequence.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/optics/light.hpp"
#include "tools/render/world/rooms/held.hpp"
#include "tools/render/world/rooms/room.hpp"
#include "tools/render/world/rooms/table_setter.hpp"

namespace houghstream::world {
namespace {

// Aspects of a sequence's world, each with a seed of its own (aspect_seed).
namespace sequence_aspect {
enum : std::uint64_t { kRoom = 1, kLight, kTable, kHands, kPath, kNoise, kFirstThing = 1000 };
}  // namespace sequence_aspect

constexpr std::uint64_t kFirstWorld = 1ULL << 43U;  // far beyond the numbers of other uses
constexpr double kComeS = 0.6;                      // duration of a hand's coming, and of its going
constexpr double kTallestBesideM = 0.16;            // a maximum, so that surrounding assets do not hide the objects
const Eigen::Vector3d kOutOfSight(0.0, 0.0, -50.0);

double eased(double fraction) {
  const double t = std::clamp(fraction, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

Eigen::Isometry3d at_stop(const Eigen::Vector3d& place, double angle_rad, double height_m) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(place + Eigen::Vector3d(0.0, 0.0, 0.5 * height_m));
  T.rotate(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()));
  return T;
}

bool moves(const Actor& actor) {
  return actor.stops.size() > 1;
}

bool is_away(const Eigen::Vector3d& place) {
  return place.head<2>().norm() > kAwayM;
}

/// Returns the pose between two stops; the way to a later one may be lifted.
Eigen::Isometry3d between(const Stop& from, const Stop& to, double seconds, double height_m) {
  const double fraction = eased((seconds - from.at_s) / (to.at_s - from.at_s));
  Eigen::Vector3d place = from.place + fraction * (to.place - from.place);
  place.z() += to.arc_m * std::sin(M_PI * fraction);
  return at_stop(place, from.angle_rad + fraction * (to.angle_rad - from.angle_rad), height_m);
}

Eigen::Isometry3d look_from(double azimuth_rad, double elevation_rad, double distance_m) {
  const Eigen::Vector3d target(0.0, 0.02, 0.05);
  const Eigen::Vector3d direction(std::sin(azimuth_rad) * std::cos(elevation_rad),
                                  -std::cos(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad));
  return look_at(target + distance_m * direction, target);
}

/// Returns the pose after a push that begins at `start_s`, is over after a quarter of a second and leaves some of its
/// motion.
Eigen::Isometry3d jerked(const Eigen::Isometry3d& T_camera_world, double seconds, double start_s, double sign) {
  const double rise = eased((seconds - start_s) / 0.12);
  const double back = 0.7 * eased((seconds - start_s - 0.12) / 0.25);
  const double amount = sign * (rise - back);
  const Eigen::AngleAxisd rotation(0.12 * amount, Eigen::Vector3d(0.3, 1.0, 0.1).normalized());
  return Eigen::Translation3d(0.06 * amount, 0.03 * amount, 0.0) * rotation * T_camera_world;
}

}  // namespace

Sequence::Sequence(SequencePlan plan, DatasetSplit use) : plan_(std::move(plan)) {
  std::uint64_t number = kFirstWorld;  // every sequence has its own room
  for (const char letter : plan_.name) number = number * 31 + static_cast<std::uint8_t>(letter);
  seed_ = world_seed(use, number);
  furnish();
  add_actors();
  add_hands();
  if (plan_.arm_passes) add_passing_arm();
  lit_ = light_world(world_at(0.0));
}

void Sequence::furnish() {
  World& world = lit_.world;
  Room room = make_room(RoomStyle::kTable, aspect_seed(seed_, sequence_aspect::kRoom));
  world.items = std::move(room.items);
  set_lighting(world, TimeOfDay::kDay, aspect_seed(seed_, sequence_aspect::kLight));
  TableSetter setter(world, room.table_half, aspect_seed(seed_, sequence_aspect::kTable));
  // Distractors surround the objects to both sides and behind; one is a hard negative.
  const int alike = kClassCount + 1 + setter.random().below(kClassCount);
  setter.stand(make_taught_object(alike).thing, setter.region(0.6, 0.95, -0.3, 0.9), M_PI, 0);
  for (int i = 0; i < 9; ++i) {
    const std::uint64_t asset_seed = aspect_seed(seed_, sequence_aspect::kFirstThing + static_cast<std::uint64_t>(i));
    const AssetPtr thing = i < 3 ? make_other_instance(1 + i, asset_seed)
                                 : make_distractor(setter.random().below(kDistractorKinds), asset_seed);
    const bool behind = i % 3 == 0;
    if (thing_height(*thing) > (behind ? 0.3 : kTallestBesideM)) continue;
    const double side = i % 3 == 1 ? -1.0 : 1.0;
    const Eigen::AlignedBox2d where =
        behind ? setter.region(-0.9, 0.9, 0.62, 0.95)
               : setter.region(std::min(0.62 * side, 0.95 * side), std::max(0.62 * side, 0.95 * side), -0.8, 0.9);
    setter.stand(thing, where, M_PI, 0);
  }
}

void Sequence::add_actors() {
  for (const Actor& actor : plan_.actors) {
    const TaughtObject object = make_taught_object(actor.object_id);
    items_.push_back(lit_.world.items.size());
    lit_.world.items.push_back({object.thing, Eigen::Isometry3d::Identity(), object.id, !moves(actor)});
  }
}

void Sequence::add_hands() {
  Random random(aspect_seed(seed_, sequence_aspect::kHands));
  for (std::size_t i = 0; i < plan_.actors.size(); ++i) {
    const std::vector<Stop>& stops = plan_.actors[i].stops;
    for (std::size_t k = 1; k < stops.size(); ++k) {
      if (stops[k].place == stops[k - 1].place && stops[k].angle_rad == stops[k - 1].angle_rad) continue;
      const bool comes_back = is_away(stops[k - 1].place);
      const Stop& on_table = comes_back ? stops[k] : stops[k - 1];
      PlacedAsset object = lit_.world.items[items_[i]];
      object.T_world_object = at_stop(on_table.place, on_table.angle_rad, thing_height(*object.thing));
      HeldPlace place;
      for (int camera = 0; camera < cameras(); ++camera) place.views.push_back(T_camera_world(camera, on_table.at_s));
      place.over = on_table.place.head<2>();
      place.arm_azimuth_rad = on_table.place.x() < 0.0 ? M_PI : 0.0;
      PlacedAsset hand = take_hold(object, place, random);
      hand.casts_shadow = false;
      carries_.push_back({i, lit_.world.items.size(), object.T_world_object.inverse() * hand.T_world_object,
                          stops[k - 1].at_s, stops[k].at_s});
      lit_.world.items.push_back(hand);
    }
  }
}

void Sequence::add_passing_arm() {
  Random random(aspect_seed(seed_, sequence_aspect::kHands));
  PlacedAsset object{make_taught_object(4).thing, at_stop({0.35, -0.36, 0.2}, 0.0, 0.12), 0, false};
  HeldPlace place;
  place.views = {T_camera_world(0, 0.0)};
  place.arm_azimuth_rad = 0.2;
  PlacedAsset hand = take_hold(object, place, random);
  hand.casts_shadow = false;
  T_world_arm_ = hand.T_world_object;
  arm_ = lit_.world.items.size();
  lit_.world.items.push_back(hand);
}

int Sequence::cameras() const {
  return plan_.cameras == CameraWork::kThreeStill ? 3 : 1;
}

Eigen::Isometry3d Sequence::T_camera_world(int camera, double seconds) const {
  if (plan_.cameras == CameraWork::kWalk) {
    Trajectory path;
    path.azimuth_start_rad = -1.25;
    path.azimuth_end_rad = 1.25;
    path.elevation_rad = 0.6;
    path.elevation_swing_rad = 0.1;
    path.distance_m = 1.05;
    path.distance_swing_m = 0.15;
    path.phase_rad = 1.0;
    return camera_at(path, seconds / plan_.seconds);
  }
  const std::array<double, 3> azimuths = {0.1, -1.2, 1.25};
  Eigen::Isometry3d T = look_from(azimuths.at(static_cast<std::size_t>(camera)), 0.62, camera == 0 ? 0.95 : 1.1);
  if (plan_.cameras != CameraWork::kJerk) return T;
  return jerked(jerked(T, seconds, 3.0, 1.0), seconds, 5.5, -0.7);
}

Eigen::Isometry3d Sequence::T_world_actor(std::size_t actor, double seconds) const {
  const std::vector<Stop>& stops = plan_.actors[actor].stops;
  const double height_m = thing_height(*lit_.world.items[items_[actor]].thing);
  const auto next = std::find_if(stops.begin(), stops.end(), [&](const Stop& stop) { return stop.at_s > seconds; });
  if (next == stops.begin()) return at_stop(next->place, next->angle_rad, height_m);
  if (next == stops.end()) return at_stop(stops.back().place, stops.back().angle_rad, height_m);
  return between(*(next - 1), *next, seconds, height_m);
}

SequenceGroundTruth Sequence::truth(double seconds) const {
  SequenceGroundTruth truth;
  for (std::size_t i = 0; i < plan_.actors.size(); ++i) {
    const Eigen::Isometry3d T = T_world_actor(i, seconds);
    truth.T_world_object.push_back(is_away(T.translation()) ? std::nullopt : std::optional<Eigen::Isometry3d>(T));
  }
  for (int i = 0; i < cameras(); ++i) truth.T_camera_world.push_back(T_camera_world(i, seconds));
  return truth;
}

World Sequence::world_at(double seconds) const {
  World world = lit_.world;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    Eigen::Isometry3d& T = world.items[items_[i]].T_world_object;
    T = T_world_actor(i, seconds);
    if (is_away(T.translation())) T.translation() = kOutOfSight;
  }
  for (const Carry& carry : carries_) {
    Eigen::Isometry3d& T = world.items[carry.hand].T_world_object;
    const double away = std::max(eased((carry.start_s - seconds) / kComeS), eased((seconds - carry.end_s) / kComeS));
    T = T_world_actor(carry.actor, std::clamp(seconds, carry.start_s, carry.end_s)) * carry.T_object_hand;
    T = Eigen::Translation3d(0.6 * away * (T.linear().col(0) + Eigen::Vector3d(0.0, 0.0, 0.3))) * T;
    if (away >= 1.0 || is_away(T.translation())) T.translation() = kOutOfSight;
  }
  if (arm_) {
    // The arm moves in front of all objects, from the right to the left within five seconds, and back.
    const double fraction = eased((seconds - 1.5) / 3.0) - eased((seconds - 5.0) / 2.5);
    world.items[*arm_].T_world_object = Eigen::Translation3d(0.75 - 1.2 * fraction, 0.0, 0.0) * T_world_arm_;
  }
  return world;
}

RenderedFrame Sequence::render(int camera, double seconds, int index) const {
  const LitWorld lit{world_at(seconds), lit_.shadows};
  const std::uint64_t noise =
      aspect_seed(aspect_seed(seed_, sequence_aspect::kNoise), static_cast<std::uint64_t>(camera));
  return render_frame(lit, T_camera_world(camera, seconds), aspect_seed(noise, static_cast<std::uint64_t>(index)));
}

}  // namespace houghstream::world
