#include "tools/render/world/training_views.hpp"

#include <cmath>
#include <set>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream::world {
namespace {

constexpr double kTopM = 0.02;
constexpr std::uint64_t kAttitudeViews = 100000;  // numbers of one attitude's views, more than there can be
constexpr std::uint64_t kFirstViewRoom = 900000;  // numbers of training worlds that backgrounds do not use

AssetPtr make_turntable_disc(Random& random) {
  const cv::Mat cover = plain({256, 256}, hsv(random.uniform(0, 360), 0.1, random.uniform(0.3, 0.8)), 0.05, random);
  return make_asset("turntable", rotated_mesh({{0.17, 0.0}, {0.17, kTopM}}, cover), 0.08F);
}

double degrees(double value) {
  return value * M_PI / 180.0;
}

}  // namespace

TurntableWorld::TurntableWorld(const TurntableSettings& settings, std::uint64_t seed)
    : settings_(settings), seed_(seed) {
  require(settings.azimuths >= 1 && settings.azimuths <= 720, "turntable: {} azimuths, expected 1 to 720",
          settings.azimuths);
  require(settings.pitches >= 1 && settings.pitches <= 90, "turntable: {} pitches, expected 1 to 90", settings.pitches);
  require(!settings.attitudes.empty(), "turntable: no attitudes, expected at least one");
  const std::set<Attitude> different(settings.attitudes.begin(), settings.attitudes.end());
  require(different.size() == settings.attitudes.size(), "turntable: an attitude is named twice, expected each once");
  for (int pitch = 0; pitch < settings.pitches; ++pitch) {
    const auto number = seed * 100000U + kFirstViewRoom + static_cast<std::uint64_t>(pitch);
    const std::uint64_t scene_seed = world_seed(DatasetSplit::kTraining, number);
    World world;
    world.items = make_room(static_cast<RoomStyle>(pitch % kRoomStyles), aspect_seed(scene_seed, 1)).items;
    set_lighting(world, TimeOfDay::kDay, aspect_seed(scene_seed, 2));
    world.focus_radius_m = 0.5;
    Random random(aspect_seed(scene_seed, 3));
    PlacedAsset disc{make_turntable_disc(random), Eigen::Isometry3d::Identity(), 0, true};
    disc.T_world_object.translate(Eigen::Vector3d(0, 0, 0.5 * kTopM));
    world.items.push_back(disc);
    worlds_.push_back(std::move(world));
  }
}

int TurntableWorld::azimuths(Attitude attitude, const AttitudeChoice* choice) const {
  if (attitude != Attitude::kLying) return settings_.azimuths;
  require(choice != nullptr, "turntable: lying views wanted, and no attitudes to choose from");
  return choice->lying_count() * ((settings_.azimuths + 1) / 2);
}

int TurntableWorld::view_count(const AttitudeChoice* choice) const {
  int count = 0;
  for (const Attitude attitude : settings_.attitudes) count += azimuths(attitude, choice) * settings_.pitches;
  return count;
}

RenderedFrame TurntableWorld::render(const TaughtObject& object, const AttitudeChoice* choice, int index) const {
  std::size_t block = 0;
  while (index >= azimuths(settings_.attitudes.at(block), choice) * settings_.pitches)
    index -= azimuths(settings_.attitudes.at(block++), choice) * settings_.pitches;
  const Attitude attitude = settings_.attitudes[block];
  const int azimuths_here = azimuths(attitude, choice);
  const int pitch_index = index / azimuths_here;
  const int azimuth_index = index % azimuths_here;
  const std::uint64_t first = kAttitudeViews * static_cast<std::uint64_t>(attitude);
  const auto number = static_cast<std::uint64_t>(object.id) * 1000003U + first + static_cast<std::uint64_t>(index);
  Random random(aspect_seed(world_seed(DatasetSplit::kTraining, seed_), number));
  Eigen::Matrix3d R_table_object = Eigen::Matrix3d::Identity();
  if (attitude != Attitude::kUpright) {
    require(choice != nullptr, "turntable: {}: no attitudes to choose from", object.name);
    R_table_object = choice->R_table_object(attitude, azimuth_index + pitch_index, random);
  }

  World world = worlds_[static_cast<std::size_t>(pitch_index)];
  PlacedAsset placed{object.thing, Eigen::Isometry3d::Identity(), object.id, true};
  const double centre = kTopM + height_above_table(object.thing->mesh, R_table_object);
  placed.T_world_object.translate(Eigen::Vector3d(0, 0, centre));
  placed.T_world_object.rotate(Eigen::AngleAxisd(2.0 * M_PI * azimuth_index / azimuths_here, Eigen::Vector3d::UnitZ()));
  placed.T_world_object.rotate(R_table_object);
  world.items.push_back(placed);

  const double fraction = settings_.pitches > 1 ? static_cast<double>(pitch_index) / (settings_.pitches - 1) : 0.5;
  const double pitch =
      degrees(settings_.lowest_pitch_deg + fraction * (settings_.highest_pitch_deg - settings_.lowest_pitch_deg));
  const double distance = settings_.distance_m * random.uniform(0.96, 1.04);
  const Eigen::Vector3d target(random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), centre);
  const Eigen::Vector3d eye = target + distance * Eigen::Vector3d(0.0, -std::cos(pitch), std::sin(pitch));
  return render_frame(light_world(std::move(world)), look_at(eye, target), random.bits() & ~1ULL);
}

}  // namespace houghstream::world
