#include "tools/render/world/takes/take.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "tools/render/world/optics/photo.hpp"

namespace houghstream::world {
namespace {

constexpr int kMeterEvery = 4;  // frames
constexpr double kMeterScale = 0.125;
constexpr double kFollowPerS = 3.0;  // how fast automatic exposure follows
constexpr double kReadoutS = 0.02;
constexpr double kUsualExposureS = 0.010;  // at exposure 1; longer in the dark
constexpr double kMinDurationS = 0.003;
constexpr double kMaxDurationS = 0.025;
constexpr std::uint64_t kNoiseAspect = 7;

constexpr std::array<std::pair<const char*, TakeKind>, 12> kShown = {{{"bowl", TakeKind::kHandHeld},
                                                                      {"cereal_box", TakeKind::kHandHeld},
                                                                      {"coffee_mug", TakeKind::kHandHeld},
                                                                      {"soda_can", TakeKind::kHandHeld},
                                                                      {"teapot", TakeKind::kTurntable},
                                                                      {"tumbler", TakeKind::kHandHeld},
                                                                      {"shampoo_bottle", TakeKind::kHandHeld},
                                                                      {"food_tin", TakeKind::kHandTurns},
                                                                      {"tea_box", TakeKind::kHandTurns},
                                                                      {"office_stapler", TakeKind::kHandHeld},
                                                                      {"toy_truck", TakeKind::kTurntable},
                                                                      {"flashlight", TakeKind::kHandHeld}}};

}  // namespace

Take::Take(const TakePlan& plan, int frames, int threads)
    : stage_(plan), seconds_(plan.seconds), frames_(frames), lit_world_(light_world(stage_.world())) {
  require(frames >= 2, "take: {} frames, expected at least 2", frames);
  meter_light(threads);
}

LitWorld Take::lit_at(double seconds) const {
  LitWorld lit_world = lit_world_;
  stage_.move(lit_world.world, seconds);
  return stage_.things_move() ? light_world(std::move(lit_world.world)) : lit_world;
}

// Automatic exposure sees a small picture of the room and follows it with a delay, proportionally.
void Take::meter_light(int threads) {
  const int count = (frames_ - 1) / kMeterEvery + 2;
  std::vector<double> metered(static_cast<std::size_t>(count));
  const Camera camera = synthetic_camera().scaled(kMeterScale);
  parallel_for(threads, count, [&](int i) {
    World world = stage_.world();
    const Eigen::Isometry3d T_camera_world = stage_.move(world, time_of(std::min(i * kMeterEvery, frames_ - 1)));
    const ShadedView view = shade_view({std::move(world), lit_world_.shadows}, camera, T_camera_world);
    metered[static_cast<std::size_t>(i)] = automatic_exposure(view.radiance, lit_world_.world.photo);
  });
  const double follow = 1.0 - std::exp(-kFollowPerS * seconds_ / (frames_ - 1));
  double exposure = metered.front();
  for (int i = 0; i < frames_; ++i) {
    const auto before = static_cast<std::size_t>(i / kMeterEvery);
    const double share = static_cast<double>(i % kMeterEvery) / kMeterEvery;
    const double wanted = (1.0 - share) * metered[before] + share * metered[before + 1];
    exposure *= std::pow(wanted / exposure, follow);
    exposures_.push_back(exposure);
  }
}

RenderedFrame Take::render(int index) const {
  const double now = time_of(index);
  const double exposure = exposures_.at(static_cast<std::size_t>(index));
  LitWorld lit_world = lit_at(now);
  lit_world.world.photo.exposure = exposure;
  const Shutter shutter{std::clamp(kUsualExposureS * exposure, kMinDurationS, kMaxDurationS), kReadoutS};
  const auto motion = [this](World& world, double seconds) { return stage_.move(world, seconds); };
  const ShadedView view = expose(lit_world, synthetic_camera(), motion, now, shutter);
  const Eigen::Isometry3d T_camera_world = stage_.move(lit_world.world, now);
  const std::uint64_t noise = aspect_seed(stage_.seed(), kNoiseAspect);
  return record_view(lit_world, T_camera_world, view, aspect_seed(noise, static_cast<std::uint64_t>(index)));
}

std::vector<NumberedTake> twelve_objects_takes(DatasetSplit use, int world, double seconds) {
  std::vector<NumberedTake> takes;
  for (const auto& [name, kind] : kShown) {
    const std::uint64_t room = static_cast<std::uint64_t>(world) * kShown.size() + takes.size() / 2;
    for (const int take : {1, 2}) {
      TakePlan plan;
      plan.object_id = taught_object_id(name);
      plan.kind = kind;
      plan.laid_down = take == 2;
      plan.use = use;
      plan.number = room;
      plan.seconds = seconds;
      takes.push_back({static_cast<int>(takes.size()) + 1, take, name, plan});
    }
  }
  return takes;
}

}  // namespace houghstream::world
