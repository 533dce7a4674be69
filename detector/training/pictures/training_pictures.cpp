#include "detector/training/pictures/training_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "detector/training/pictures/camera_variation.hpp"
#include "detector/training/pictures/composites.hpp"
#include "detector/training/pictures/sensor_errors.hpp"

namespace houghstream::training {
namespace {

bool in_scale_space(const Profile& profile) {
  return profile.features.handling == ScaleHandling::kScaleSpace;
}

/// Whether features look at the depth that a scale space's enlarged images show, see add_far_noise.
bool needs_far_noise(const Profile& profile) {
  return in_scale_space(profile) && profile.features.families != kIntensity;
}

/// Whether a level is taught a surface at this depth: a little beyond what it holds, since detection decides by noisy
/// depth; anything in a scale space.
bool teaches(const FeatureLevel& level, const Profile& profile, float depth) {
  return in_scale_space(profile) || (depth > 0.85F * level.min_distance && depth <= 1.15F * level.max_distance);
}

/// How far away the object is put: anywhere, or in a scale space about where it was, since sizes between those that are
/// searched must be known too.
double draw_distance(const TrainingView& view, const Profile& profile, Random& random) {
  constexpr double kHalfStep = 1.25;  // of the scales searched
  const TrainingSettings& settings = profile.training;
  const double taught = view.T_camera_object.translation().z();
  const double nearest = in_scale_space(profile) ? taught / kHalfStep : settings.min_distance;
  const double farthest = in_scale_space(profile) ? taught * kHalfStep : settings.max_distance;
  return std::exp(random.uniform(std::log(nearest), std::log(farthest)));
}

/// The level that sees an object at this distance; either one near the limit between them.
FeatureLevel level_for(double distance, const Camera& camera, const Profile& profile, Random& random) {
  if (in_scale_space(profile)) return {profile.features.image_scale, 1.0F, 0.0F, 0.0F};
  const std::vector<FeatureLevel> levels = feature_levels(profile.features, camera);
  return distance * random.uniform(0.9, 1.1) > levels[0].max_distance ? levels.back() : levels[0];
}

/// Random pixels of the working frame that `wanted` accepts, at most `count`.
template <typename Wanted>
std::vector<cv::Point> draw_pixels(cv::Size size, int count, Random& random, const Wanted& wanted) {
  std::vector<cv::Point> all;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (wanted(x, y)) all.emplace_back(x, y);
    }
  }
  const int taken = std::min(count, static_cast<int>(all.size()));
  for (int i = 0; i < taken; ++i) {
    std::swap(all[static_cast<std::size_t>(i)],
              all[static_cast<std::size_t>(random.between(i, static_cast<int>(all.size()) - 1))]);
  }
  all.resize(static_cast<std::size_t>(taken));
  return all;
}

TrainingSample sample_at(cv::Point at, const WorkingFrame& frame, const Profile& profile) {
  TrainingSample sample;
  sample.x = static_cast<std::int16_t>(at.x);
  sample.y = static_cast<std::int16_t>(at.y);
  sample.scale = in_scale_space(profile)
                     ? limited_scale(profile.patch, profile.patch.unit)
                     : patch_scale(profile.patch, frame.camera.fx, frame.filled_depth.at<float>(at));
  return sample;
}

/// From a surface point to the object's centre, in the ray frame of the pixel that shows the point; in a scale space
/// from pixel to pixel, as if 1 m away.
Eigen::Vector3f centre_offset(const TrainingView& view, const Composite& composite, cv::Point2d frame_px, float depth,
                              const Profile& profile) {
  const cv::Point2d view_px = (frame_px - composite.origin_px) / composite.scale;
  const Camera& camera = view.frame.camera;
  if (in_scale_space(profile)) {
    const Eigen::Vector2d centre_px = camera.project(view.T_camera_object.translation());
    const Eigen::Vector2d offset = (centre_px - Eigen::Vector2d(view_px.x, view_px.y)) * composite.scale;
    return {static_cast<float>(offset.x() / camera.fx), static_cast<float>(offset.y() / camera.fy), 0.0F};
  }
  const Eigen::Vector3d point = camera.backproject(view_px.x, view_px.y, depth - composite.depth_change.at(frame_px));
  const Eigen::Vector3d offset = view.T_camera_object.translation() - point;
  return ray_rotation(point.cast<float>()).transpose() * offset.cast<float>();
}

/// The composite as a level works on it, and where patches may be drawn.
struct Canvas {
  WorkingFrame frame;
  cv::Mat mask;      // of the object, working pixels
  cv::Mat measured;  // depth without what holes have borrowed
  double to_frame = 1.0;

  /// A hole's borrowed depth may be the background's and a rim's may be an occluder's: good enough to look at a patch,
  /// not to learn where the centre is.
  bool depth_is_measured(int x, int y) const {
    return std::abs(measured.at<float>(y, x) - frame.filled_depth.at<float>(y, x)) < 0.02F;
  }
  cv::Point2d frame_px(cv::Point at) const { return {(at.x + 0.5) * to_frame - 0.5, (at.y + 0.5) * to_frame - 0.5}; }
};

Canvas make_canvas(const Composite& composite, const FeatureLevel& level, const Profile& profile) {
  Canvas canvas;
  canvas.frame = make_working_frame(composite.frame, level, profile.features);
  const cv::Size size = canvas.frame.colour.size();
  cv::resize(composite.mask, canvas.mask, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(composite.frame.depth, canvas.measured, size, 0, 0, cv::INTER_NEAREST);
  canvas.to_frame = static_cast<double>(composite.mask.cols) / size.width;
  return canvas;
}

/// All features of a picture; they stay until the next one.
const FeatureImage& all_features(const WorkingFrame& frame, const FeatureSettings& settings, PictureWorkspace& own) {
  own.tiles.want_all(frame.colour.size());
  compute_features({frame, settings, own.tiles}, 1, own.feature_memory, own.features);
  return own.features;
}

/// What the patches of a picture look at.
cv::Rect seen_by(const TrainingPicture& picture, const PatchSettings& patch) {
  cv::Rect seen;
  for (const auto* list : {&picture.samples, &picture.spare_background}) {
    for (const TrainingSample& sample : *list) {
      const int reach = farthest_offset(patch, sample.scale);
      seen |= cv::Rect(sample.x - reach, sample.y - reach, 2 * reach + 1, 2 * reach + 1);
    }
  }
  return seen;
}

/// A part of the background that the level sees something in, or any part where there is none.
cv::Rect background_window(const RgbdFrame& background, const FeatureLevel& level, const Profile& profile,
                           Random& random) {
  constexpr int kTries = 12;
  const float share = std::min(0.5F, 1.0F / (4.0F * level.scale));
  const cv::Size size(static_cast<int>(static_cast<float>(background.colour.cols) * share),
                      static_cast<int>(static_cast<float>(background.colour.rows) * share));
  cv::Rect place;
  for (int i = 0; i < kTries; ++i) {
    place = cv::Rect(random.between(0, background.colour.cols - size.width),
                     random.between(0, background.colour.rows - size.height), size.width, size.height);
    int held = 0;
    for (int y = 0; y < size.height; y += 8) {
      for (int x = 0; x < size.width; x += 8) {
        held += teaches(level, profile, background.depth.at<float>(place.y + y, place.x + x)) ? 1 : 0;
      }
    }
    if (held * 64 * 3 > size.area()) break;
  }
  return place;
}

}  // namespace

TrainingPicture object_picture(const TaughtView& taught, const RgbdFrame& background, const Profile& profile,
                               Random& random, PictureWorkspace& own) {
  const TrainingView& view = taught.view;
  const TrainingSettings& settings = profile.training;
  TrainingPicture picture;
  double distance = draw_distance(view, profile, random);
  std::optional<Composite> composite = make_composite(view, background, distance, settings, random);
  if (!composite) {
    distance = view.T_camera_object.translation().z();
    composite = make_composite(view, background, distance, settings, random);
  }
  if (!composite) return picture;

  vary_tone(settings.tone_share, settings.camera_variation, composite->frame.colour, random);
  if (needs_far_noise(profile)) {
    const double farthest = *std::max_element(profile.features.scales.begin(), profile.features.scales.end());
    add_far_noise(distance, std::exp(random.uniform(0.0, std::log(farthest))), composite->frame.depth, random);
  }
  const FeatureLevel level = level_for(distance, composite->frame.camera, profile, random);
  const Canvas canvas = make_canvas(*composite, level, profile);
  const bool needs_depth = !in_scale_space(profile);
  const auto known = [&](int x, int y) { return teaches(level, profile, canvas.frame.filled_depth.at<float>(y, x)); };
  const auto on_object = [&](int x, int y) {
    return canvas.mask.at<std::uint8_t>(y, x) != 0 && known(x, y) && (!needs_depth || canvas.depth_is_measured(x, y));
  };
  const auto beside = [&](int x, int y) { return canvas.mask.at<std::uint8_t>(y, x) == 0 && known(x, y); };

  const int count = settings.patches_per_view / settings.composites_per_view;
  for (const cv::Point at : draw_pixels(canvas.mask.size(), count, random, on_object)) {
    TrainingSample sample = sample_at(at, canvas.frame, profile);
    const float depth = canvas.frame.filled_depth.at<float>(at);
    sample.offset = centre_offset(view, *composite, canvas.frame_px(at), depth, profile);
    sample.label = static_cast<std::uint16_t>(taught.label);
    sample.view = taught.index;
    picture.samples.push_back(sample);
  }
  for (const cv::Point at : draw_pixels(canvas.mask.size(), count / 4, random, beside)) {
    picture.samples.push_back(sample_at(at, canvas.frame, profile));
  }
  const double px = composite->frame.camera.metres_per_px(needs_depth ? distance : 1.0);
  picture.whole_area = static_cast<float>(composite->whole_px * px * px);
  picture.features = all_features(canvas.frame, profile.features, own).cut_out(seen_by(picture, profile.patch));
  return picture;
}

TrainingPicture background_picture(const RgbdFrame& background, const FeatureLevel& level, const Profile& profile,
                                   Random& random, PictureWorkspace& own) {
  const TrainingSettings& settings = profile.training;
  const cv::Rect place = background_window(background, level, profile, random);
  RgbdFrame part;
  part.colour = background.colour(place).clone();
  part.depth = background.depth(place);
  part.camera = background.camera.cropped(place.x, place.y, place.width, place.height);
  vary_exposure(part.colour, settings.light_variation, random);
  vary_tone(settings.tone_share, settings.camera_variation, part.colour, random);

  const WorkingFrame frame = make_working_frame(part, level, profile.features);
  TrainingPicture picture;
  const auto known = [&](int x, int y) { return teaches(level, profile, frame.filled_depth.at<float>(y, x)); };
  const auto count = static_cast<std::size_t>(settings.patches_per_room / kBackgroundPictures);
  const int drawn = static_cast<int>(count) * (1 + settings.spare_background);
  for (const cv::Point at : draw_pixels(frame.colour.size(), drawn, random, known)) {
    auto& list = picture.samples.size() < count ? picture.samples : picture.spare_background;
    list.push_back(sample_at(at, frame, profile));
  }
  picture.features = all_features(frame, profile.features, own).cut_out(seen_by(picture, profile.patch));
  return picture;
}

}  // namespace houghstream::training
