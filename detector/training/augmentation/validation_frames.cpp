#include "detector/training/augmentation/validation_frames.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "detector/training/augmentation/camera_randomisation.hpp"
#include "detector/training/augmentation/composites.hpp"
#include "detector/training/augmentation/sensor_errors.hpp"

namespace houghstream::training {
namespace {

double draw_distance(const AugmentationSettings& settings, Random& random) {
  return std::exp(random.uniform(std::log(settings.min_distance), std::log(settings.max_distance)));
}

/// A frame in the making.
struct Stage {
  RgbdFrame& frame;
  cv::Mat labels;  // CV_8UC1: which object each pixel shows, 0 = none
  const AugmentationSettings& settings;
  Random& random;
};

/// Copies the composite into the whole frame it was cut from.
void put_back(const Composite& composite, std::uint8_t label, Stage& stage) {
  RgbdFrame& frame = stage.frame;
  cv::Mat& labels = stage.labels;
  const cv::Rect place(static_cast<int>(std::lround(frame.camera.cx - composite.frame.camera.cx)),
                       static_cast<int>(std::lround(frame.camera.cy - composite.frame.camera.cy)), composite.mask.cols,
                       composite.mask.rows);
  composite.frame.colour.copyTo(frame.colour(place));
  composite.frame.depth.copyTo(frame.depth(place));
  if (!composite.occluder.empty()) labels(place).setTo(0, composite.occluder);
  labels(place).setTo(label, composite.mask);
}

/// Returns how many pixels it has as a whole; 1 where there is no room for it.
int put(const TrainingView& thing, double distance, std::uint8_t label, Stage& stage) {
  const TrainingView bent_view = perturb_shape(thing, stage.settings.depth_error, stage.random);
  const std::optional<Composite> composite =
      make_composite(bent_view, stage.frame, distance, stage.settings, stage.random);
  if (!composite) return 1;
  put_back(*composite, label, stage);
  return composite->whole_px;
}

std::uint32_t draw_view(const std::vector<const TrainingView*>& views, Random& random) {
  return static_cast<std::uint32_t>(random.below(static_cast<int>(views.size())));
}

/// Returns the view of a thing with the object's shape and pattern, but other colours: hues are turned, and some are
/// added where there are none; it is darker or brighter.
TrainingView recoloured(const TrainingView& view, Random& random) {
  constexpr double kNeutral = 128.0;
  const double angle = random.uniform(0.5 * M_PI, 1.5 * M_PI);
  const double cast_angle = random.uniform(0.0, 2.0 * M_PI);
  const double cast = random.uniform(10.0, 30.0);
  const double lightness = std::exp2(random.uniform(-1.3, 0.4));
  TrainingView out = view;
  cv::Mat lab;
  cv::cvtColor(view.frame.colour, lab, cv::COLOR_BGR2Lab);
  for (int y = 0; y < lab.rows; ++y) {
    for (int x = 0; x < lab.cols; ++x) {
      cv::Vec3b& pixel = lab.at<cv::Vec3b>(y, x);
      const double a = pixel[1] - kNeutral;
      const double b = pixel[2] - kNeutral;
      pixel[0] = cv::saturate_cast<std::uint8_t>(lightness * pixel[0]);
      pixel[1] = cv::saturate_cast<std::uint8_t>(kNeutral + std::cos(angle) * a - std::sin(angle) * b +
                                                 cast * std::cos(cast_angle));
      pixel[2] = cv::saturate_cast<std::uint8_t>(kNeutral + std::sin(angle) * a + std::cos(angle) * b +
                                                 cast * std::sin(cast_angle));
    }
  }
  out.frame.colour = cv::Mat();  // the view's own pixels stay as they are
  cv::cvtColor(lab, out.frame.colour, cv::COLOR_Lab2BGR);
  return out;
}

/// Returns the view of a thing that looks like the object, but is clearly smaller or larger.
TrainingView resized(const TrainingView& view, Random& random) {
  const double size = random.uniform() < 0.5 ? random.uniform(0.5, 0.75) : random.uniform(1.33, 1.8);
  TrainingView out = view;
  out.frame.depth = cv::Mat();  // the view's own pixels stay as they are
  view.frame.depth.convertTo(out.frame.depth, CV_32FC1, size);
  out.T_camera_object.translation() *= size;
  return out;
}

/// Returns the view of a thing with the object's colours and pattern, but clearly narrower or wider.
TrainingView squeezed(const TrainingView& view, Random& random) {
  const double width = random.uniform() < 0.5 ? random.uniform(0.4, 0.7) : random.uniform(1.4, 2.2);
  const cv::Size size(std::max(1, static_cast<int>(std::lround(width * view.mask.cols))), view.mask.rows);
  const double scale = static_cast<double>(size.width) / view.mask.cols;
  TrainingView out = view;
  out.frame.colour = cv::Mat();  // the view's own pixels stay as they are
  out.frame.depth = cv::Mat();
  out.mask = cv::Mat();
  cv::resize(view.frame.colour, out.frame.colour, size, 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::resize(view.frame.depth, out.frame.depth, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(view.mask, out.mask, size, 0, 0, cv::INTER_NEAREST);
  out.frame.camera.width = size.width;
  out.frame.camera.cx = (view.frame.camera.cx + 0.5) * scale - 0.5;
  out.T_camera_object.translation().x() *= scale;
  return out;
}

/// Returns the view of a thing with one object's shape and another's colours and pattern.
TrainingView painted(const TrainingView& shape, const TrainingView& paint) {
  const cv::Rect from = cv::boundingRect(paint.mask);
  const cv::Rect to = cv::boundingRect(shape.mask);
  cv::Mat image = paint.frame.colour(from).clone();
  image.setTo(cv::mean(image, paint.mask(from)), paint.mask(from) == 0);
  TrainingView out = shape;
  out.frame.colour = shape.frame.colour.clone();
  cv::resize(image, image, to.size(), 0, 0, cv::INTER_AREA);
  image.copyTo(out.frame.colour(to), shape.mask(to));
  return out;
}

/// Adds distractors to a frame without objects.
class DistractorComposer {
 public:
  DistractorComposer(const std::vector<const TrainingView*>& objects, Stage& stage)
      : objects_(objects), stage_(stage) {}

  void add_near_duplicate(bool in_other_colours) {
    const TrainingView& view = draw();
    put_distractor(in_other_colours ? recoloured(view, stage_.random) : resized(view, stage_.random));
  }

  void add_hard_negative(bool in_other_paint) {
    const TrainingView& view = draw();
    if (!in_other_paint) return put_distractor(squeezed(view, stage_.random));
    const TrainingView& paint = draw();
    // Another view of the same object has no other paint to give.
    put_distractor(paint.class_id == view.class_id ? squeezed(view, stage_.random) : painted(view, paint));
  }

  /// Returns the views that they were made of.
  std::vector<std::uint32_t> views() && { return std::move(views_); }

 private:
  const TrainingView& draw() {
    views_.push_back(draw_view(objects_, stage_.random));
    return *objects_[views_.back()];
  }

  void put_distractor(const TrainingView& thing) {
    put(thing, draw_distance(stage_.settings, stage_.random), 0, stage_);
  }

  const std::vector<const TrainingView*>& objects_;
  Stage& stage_;
  std::vector<std::uint32_t> views_;
};

}  // namespace

ValidationFrame make_validation_frame(const std::vector<const TrainingView*>& objects, const RgbdFrame& background,
                                      const ComposedThings& things, const AugmentationSettings& settings,
                                      Random& random) {
  constexpr double kOtherLight = 2.0;  // colours must not be trusted further than light lets them
  AugmentationSettings even_light = settings;
  even_light.lighting_variation = 0.0;  // one light for the whole frame
  even_light.sharpened_fraction = 0.0;  // and one camera, as blind to detail as the one that taught
  ValidationFrame out;
  out.frame = background;
  out.frame.colour = background.colour.clone();
  out.frame.depth = background.depth.clone();
  Stage stage{out.frame, cv::Mat::zeros(background.colour.size(), CV_8UC1), even_light, random};
  std::vector<int> whole_px;
  DistractorComposer distractors(objects, stage);
  for (int i = 0; i < 2 * things.near_duplicates; ++i) distractors.add_near_duplicate(i % 2 == 0);
  for (int i = 0; i < 2 * things.hard_negatives; ++i) distractors.add_hard_negative(i % 2 == 0);
  out.distractor_views = std::move(distractors).views();
  for (int label = 1; label <= things.objects; ++label) {
    const std::uint32_t index = draw_view(objects, random);
    const TrainingView& view = *objects[index];
    const double distance = draw_distance(settings, random);
    const TrainingView object = perturb_appearance(view, settings.surface_variation, random);
    whole_px.push_back(put(object, distance, static_cast<std::uint8_t>(label), stage));
    out.objects.push_back({view.class_id, index, {}, 0.0});
  }
  for (int label = 1; label <= things.objects; ++label) {
    const auto index = static_cast<std::size_t>(label - 1);
    ValidationFrame::Object& object = out.objects[index];
    const cv::Mat seen = stage.labels == label;
    object.box_visible_px = cv::boundingRect(seen);
    object.visible_fraction = static_cast<double>(cv::countNonZero(seen)) / whole_px[index];
  }
  const auto unseen = [](const ValidationFrame::Object& object) { return object.box_visible_px.empty(); };
  out.objects.erase(std::remove_if(out.objects.begin(), out.objects.end(), unseen), out.objects.end());
  misregister(settings.depth_error, out.frame.depth, random);
  jitter_exposure(out.frame.colour, kOtherLight * settings.lighting_variation, random);
  randomise_camera(settings.camera_fraction, settings.camera_randomisation, out.frame, random);
  return out;
}

}  // namespace houghstream::training
