#include "tools/teach/show/show_teaching.hpp"

#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "pose/reconstruction/model/take_model.hpp"
#include "tools/teach/mesh/mesh_checks.hpp"

namespace houghstream::teach {
namespace {

using reconstruction::Take;

/// What is taught of a view: the object with a margin, in the tone in which it is looked for.
void crop_to_object(TrainingView& view) {
  constexpr int kMargin_px = 8;
  const AffineBrightness tone = fit_affine_brightness(view.frame.colour, kCalibrationBrightness);
  cv::Rect crop = cv::boundingRect(view.mask);
  crop = cv::Rect(crop.x - kMargin_px, crop.y - kMargin_px, crop.width + 2 * kMargin_px, crop.height + 2 * kMargin_px) &
         cv::Rect({0, 0}, view.mask.size());
  cv::Mat colour;
  apply_affine_brightness(tone, view.frame.colour(crop), colour);
  view.frame.colour = colour;
  view.frame.depth = view.frame.depth(crop).clone();
  view.frame.camera = view.frame.camera.cropped(crop.x, crop.y, crop.width, crop.height);
  view.mask = view.mask(crop).clone();
}

/// Gives the model of the takes the colours that it has in pictures of the tone in which it is looked for.
void bring_into_tone(const std::vector<Take>& takes, std::vector<cv::Vec3b>& colours) {
  if (colours.empty()) return;
  AffineBrightness mean{0.0F, 0.0F};
  float count = 0.0F;
  for (const Take& take : takes) {
    for (const reconstruction::Keyframe& keyframe : take.keyframes) {
      const AffineBrightness tone = fit_affine_brightness(keyframe.frame.colour, kCalibrationBrightness);
      mean.gain += tone.gain;
      mean.offset += tone.offset;
      count += 1.0F;
    }
  }
  if (count == 0.0F) return;
  cv::Mat all(colours);  // lies where they do
  apply_affine_brightness({mean.gain / count, mean.offset / count}, all, all);
}

}  // namespace

TeachOptions options_to_teach(const ShowOptions& options, const ShowResult& shown) {
  TeachOptions teach;
  TaughtMesh mesh;
  mesh.name = options.name;
  mesh.file = "shown: " + options.source;
  mesh.mesh = shown.mesh;
  check_mesh(options.name, 1e-3, mesh.mesh);
  mesh.coloured = has_colour(mesh.mesh);
  bring_into_tone(shown.takes, mesh.mesh.colours);
  teach.shown = {std::move(mesh)};
  for (std::size_t t = 0; t < shown.takes.size(); ++t) {
    std::vector<TrainingView> own = training_views(shown.takes[t], shown.views[t], options.name);
    for (TrainingView& view : own) {
      crop_to_object(view);
      teach.own_views.push_back(std::move(view));
    }
  }
  teach.out = options.out;
  teach.add = options.add;
  teach.replace = options.replace;
  teach.rooms.cache = options.rooms_cache;
  teach.rooms.threads = options.threads;
  teach.seed = options.seed;
  teach.threads = options.threads;
  return teach;
}

}  // namespace houghstream::teach
