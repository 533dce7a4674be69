#include "tools/render/world/takes/take.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "tools/render/world/optics/photo.hpp"

namespace houghstream::world {
namespace {

constexpr int kBands = 16;
constexpr double kStillPx = 0.25;  // shorter motions are invisible
constexpr int kMaxTaps = 12;       // on each side

/// Returns the pose of each asset: T_camera_object.
std::vector<Eigen::Isometry3d> places(World& world, const SceneMotion& motion, double seconds) {
  const Eigen::Isometry3d T_camera_world = motion(world, seconds);
  std::vector<Eigen::Isometry3d> result;
  result.reserve(world.items.size());
  for (const PlacedAsset& placed : world.items) result.push_back(T_camera_world * placed.T_world_object);
  return result;
}

/// Computes the image motion of each pixel within half an exposure: CV_32FC2, pixels. The view's first row is the
/// image's row `first`.
cv::Mat half_ways(const ShadedView& view, const Camera& camera, int first,
                  const std::vector<Eigen::Isometry3d>& T_later_now) {
  cv::Mat ways(view.radiance.size(), CV_32FC2, cv::Scalar::all(0));
  for (int y = 0; y < ways.rows; ++y) {
    for (int x = 0; x < ways.cols; ++x) {
      const std::uint16_t id = view.geometry.id.at<std::uint16_t>(y, x);
      if (id == 0) continue;
      const Eigen::Vector3d later =
          T_later_now[id - 1U] * camera.backproject(x, y + first, view.geometry.depth.at<float>(y, x));
      if (later.z() < 0.05) continue;
      const Eigen::Vector2d moved = camera.project(later) - Eigen::Vector2d(x, y + first);
      ways.at<cv::Vec2f>(y, x) = {static_cast<float>(moved.x()), static_cast<float>(moved.y())};
    }
  }
  return ways;
}

cv::Vec3f smeared(const cv::Mat& radiance, int x, int y, const cv::Vec2f& way) {
  const double length = std::hypot(way[0], way[1]);
  if (length < kStillPx) return radiance.at<cv::Vec3f>(y, x);
  const int taps = std::min(kMaxTaps, static_cast<int>(std::ceil(length)));
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (int i = -taps; i <= taps; ++i) {
    const float fraction = static_cast<float>(i) / static_cast<float>(taps);
    const int from_x = std::clamp(cvRound(static_cast<float>(x) + fraction * way[0]), 0, radiance.cols - 1);
    const int from_y = std::clamp(cvRound(static_cast<float>(y) + fraction * way[1]), 0, radiance.rows - 1);
    sum += radiance.at<cv::Vec3f>(from_y, from_x);
  }
  return sum * (1.0F / static_cast<float>(2 * taps + 1));
}

void smear(const cv::Mat& ways, cv::Mat& radiance) {
  cv::Mat result(radiance.size(), CV_32FC3);
  for (int y = 0; y < radiance.rows; ++y) {
    for (int x = 0; x < radiance.cols; ++x)
      result.at<cv::Vec3f>(y, x) = smeared(radiance, x, y, ways.at<cv::Vec2f>(y, x));
  }
  radiance = result;
}

/// Returns a view of the whole image, without contents.
ShadedView empty_view(const cv::Size& size) {
  ShadedView view;
  view.geometry = {cv::Mat(size, CV_32FC1), cv::Mat(size, CV_16UC1), cv::Mat(size, CV_32SC1), cv::Mat(size, CV_32FC2)};
  view.radiance.create(size, CV_32FC3);
  view.cos_incidence.create(size, CV_32FC1);
  view.reflectance.create(size, CV_32FC1);
  view.specular.create(size, CV_32FC1);
  return view;
}

void copy_band(const ShadedView& band, const cv::Range& rows, const ShadedView& whole) {
  band.geometry.depth.copyTo(whole.geometry.depth.rowRange(rows));
  band.geometry.id.copyTo(whole.geometry.id.rowRange(rows));
  band.geometry.triangle.copyTo(whole.geometry.triangle.rowRange(rows));
  band.geometry.bary.copyTo(whole.geometry.bary.rowRange(rows));
  band.radiance.copyTo(whole.radiance.rowRange(rows));
  band.cos_incidence.copyTo(whole.cos_incidence.rowRange(rows));
  band.reflectance.copyTo(whole.reflectance.rowRange(rows));
  band.specular.copyTo(whole.specular.rowRange(rows));
}

constexpr int kMeterEvery = 4;  // frames
constexpr double kMeterScale = 0.125;
constexpr double kFollowPerS = 3.0;  // rate at which automatic exposure follows
constexpr double kReadoutS = 0.02;
constexpr double kUsualExposureS = 0.010;  // exposure time at exposure 1; longer in the dark
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

ShadedView expose(LitWorld lit_world, const Camera& camera, const SceneMotion& motion, double seconds,
                  const Shutter& shutter) {
  ShadedView whole = empty_view({camera.width, camera.height});
  cv::Mat ways(whole.radiance.size(), CV_32FC2);
  for (int band = 0; band < kBands; ++band) {
    const int first = camera.height * band / kBands;
    const int last = camera.height * (band + 1) / kBands;
    const double fraction = 0.5 * (first + last) / camera.height - 0.5;
    const double now = seconds + fraction * shutter.readout_s;
    std::vector<Eigen::Isometry3d> T_later_now = places(lit_world.world, motion, now + 0.5 * shutter.exposure_s);
    const Eigen::Isometry3d T_camera_world = motion(lit_world.world, now);
    for (std::size_t i = 0; i < T_later_now.size(); ++i) {
      T_later_now[i] = T_later_now[i] * (T_camera_world * lit_world.world.items[i].T_world_object).inverse();
    }
    const ShadedView view = shade_view(lit_world, camera, T_camera_world, {0, first, camera.width, last - first});
    copy_band(view, {first, last}, whole);
    half_ways(view, camera, first, T_later_now).copyTo(ways.rowRange(first, last));
  }
  smear(ways, whole.radiance);
  return whole;
}

RenderedTake::RenderedTake(const TakePlan& plan, int frames, int threads)
    : stage_(plan), seconds_(plan.seconds), frames_(frames), lit_world_(light_world(stage_.world())) {
  require(frames >= 2, "take: {} frames, expected at least 2", frames);
  meter_light(threads);
}

LitWorld RenderedTake::lit_at(double seconds) const {
  LitWorld lit_world = lit_world_;
  stage_.move(lit_world.world, seconds);
  return stage_.things_move() ? light_world(std::move(lit_world.world)) : lit_world;
}

// Automatic exposure reads a small image of the room and follows it with a delay, proportionally.
void RenderedTake::meter_light(int threads) {
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
    const double fraction = static_cast<double>(i % kMeterEvery) / kMeterEvery;
    const double wanted = (1.0 - fraction) * metered[before] + fraction * metered[before + 1];
    exposure *= std::pow(wanted / exposure, follow);
    exposures_.push_back(exposure);
  }
}

RenderedFrame RenderedTake::render(int index) const {
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
