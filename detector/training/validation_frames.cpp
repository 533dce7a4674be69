#include "detector/training/validation_frames.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/training/composites.hpp"

namespace houghstream {
namespace {

/// Copies the composite into the whole frame it was cut from; `labels` says which object each pixel shows.
void put_back(const Composite& composite, std::uint8_t label, RgbdFrame& frame, cv::Mat& labels) {
  const cv::Rect place(static_cast<int>(std::lround(frame.camera.cx - composite.frame.camera.cx)),
                       static_cast<int>(std::lround(frame.camera.cy - composite.frame.camera.cy)), composite.mask.cols,
                       composite.mask.rows);
  composite.frame.colour.copyTo(frame.colour(place));
  composite.frame.depth.copyTo(frame.depth(place));
  if (!composite.occluder.empty()) labels(place).setTo(0, composite.occluder);
  labels(place).setTo(label, composite.mask);
}

}  // namespace

ValidationFrame make_validation_frame(const std::vector<const TrainingView*>& objects, const RgbdFrame& room,
                                      const TrainingSettings& settings, Random& random) {
  constexpr std::uint8_t kObjects = 4;
  TrainingSettings even_light = settings;
  even_light.light_variation = 0.0;  // one light for the whole frame
  ValidationFrame out;
  out.frame = room;
  out.frame.colour = room.colour.clone();
  out.frame.depth = room.depth.clone();
  cv::Mat labels = cv::Mat::zeros(room.colour.size(), CV_8UC1);
  std::vector<int> whole_px;
  for (std::uint8_t label = 1; label <= kObjects; ++label) {
    const auto index = static_cast<std::size_t>(random.below(static_cast<int>(objects.size())));
    const TrainingView& view = *objects[index];
    const double distance = std::exp(random.uniform(std::log(settings.min_distance), std::log(settings.max_distance)));
    const std::optional<Composite> composite = make_composite(view, out.frame, distance, even_light, random);
    out.objects.push_back({view.class_id, static_cast<std::uint32_t>(index), {}, 0.0});
    whole_px.push_back(composite ? composite->whole_px : 1);
    if (composite) put_back(*composite, label, out.frame, labels);
  }
  for (std::uint8_t label = 1; label <= kObjects; ++label) {
    ValidationFrame::Object& object = out.objects[label - 1U];
    const cv::Mat seen = labels == label;
    object.box_visible_px = cv::boundingRect(seen);
    object.visible_fraction = static_cast<double>(cv::countNonZero(seen)) / whole_px[label - 1U];
  }
  const auto unseen = [](const ValidationFrame::Object& object) { return object.box_visible_px.empty(); };
  out.objects.erase(std::remove_if(out.objects.begin(), out.objects.end(), unseen), out.objects.end());
  vary_exposure(out.frame.colour, settings.light_variation, random);
  return out;
}

}  // namespace houghstream
