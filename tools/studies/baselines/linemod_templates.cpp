#include "tools/studies/baselines/linemod_templates.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "tools/studies/baselines/scaled_view.hpp"

namespace houghstream {
namespace {

const char* const kOneClass = "object";  // classes are distinguished by our own list of templates

cv::Ptr<cv::linemod::Detector> new_linemod(const LinemodTemplateSettings& settings) {
  const auto features = static_cast<std::size_t>(settings.features);
  const int max_distance_mm = static_cast<int>(settings.max_distance * 1000.0F) + 500;
  // Settings that are not listed have cv::linemod's defaults.
  constexpr float kStrongGradient = 55.0F;
  const std::vector<cv::Ptr<cv::linemod::Modality>> modalities = {
      cv::makePtr<cv::linemod::ColorGradient>(settings.weak_gradient, features, kStrongGradient),
      cv::makePtr<cv::linemod::DepthNormal>(max_distance_mm, 50, features, 2)};
  return cv::makePtr<cv::linemod::Detector>(modalities, std::vector<int>(kLinemodSteps.begin(), kLinemodSteps.end()));
}

std::vector<LinemodTemplate::DepthSample> spread_samples(const ScaledView& view, cv::Point from) {
  constexpr std::size_t kSamples = 64;
  std::vector<cv::Point> measured;
  cv::findNonZero(view.depth_mm, measured);
  std::vector<LinemodTemplate::DepthSample> samples;
  for (std::size_t i = 0; i < measured.size(); i += 1 + measured.size() / kSamples) {
    samples.push_back({measured[i] - from, static_cast<float>(view.depth_mm.at<std::uint16_t>(measured[i])) * 1e-3F});
  }
  return samples;
}

}  // namespace

LinemodShare::LinemodShare(const LinemodTemplateSettings& settings)
    : linemod_(new_linemod(settings)), focal_px_(settings.focal_px) {}

bool LinemodShare::add(const TrainingView& view, double distance, int rank) {
  const std::optional<ScaledView> scaled = scale_view(view, distance, focal_px_);
  cv::Rect features_px;
  const auto extract = [&] {
    return linemod_->addTemplate({scaled->colour, scaled->depth_mm}, kOneClass, scaled->mask, &features_px) >= 0;
  };
  if (!scaled || !extract()) {
    ++training_.refused_templates;
    return false;
  }
  ++training_.templates;
  LinemodTemplate made;
  made.class_id = view.class_id;
  made.class_name = view.class_name;
  made.distance = static_cast<float>(distance);
  made.rank = rank;
  made.box_px = cv::boundingRect(scaled->mask) - features_px.tl();
  made.origin_px = cv::Point2f(scaled->origin_px - cv::Point2d(features_px.tl()));
  made.samples = spread_samples(*scaled, features_px.tl());
  largest_.width = std::max(largest_.width, features_px.width);
  largest_.height = std::max(largest_.height, features_px.height);
  templates_.push_back(std::move(made));
  return true;
}

std::vector<LinemodMatch> LinemodShare::match(const std::vector<cv::Mat>& images, float threshold) const {
  if (templates_.empty()) return {};
  std::vector<cv::linemod::Match> found;
  linemod_->match(images, threshold, found);
  std::vector<LinemodMatch> out;
  out.reserve(found.size());
  for (const cv::linemod::Match& match : found) {
    const LinemodTemplate& shape = templates_[static_cast<std::size_t>(match.template_id)];
    out.push_back({match.similarity, &shape, {match.x, match.y}});
  }
  return out;
}

namespace {

std::vector<double> distances(const LinemodTemplateSettings& settings) {
  std::vector<double> out;
  const double last = static_cast<double>(settings.max_distance) * std::sqrt(settings.distance_step);
  for (double d = settings.min_distance; d < last; d *= settings.distance_step) out.push_back(d);
  return out;
}

void check_settings(const LinemodTemplateSettings& settings) {
  require(settings.features >= 4 && settings.features <= 63, "linemod: {} features a template, expected 4 to 63",
          settings.features);
  require(
      settings.min_distance > 0.0F && settings.max_distance >= settings.min_distance && settings.max_distance < 60.0F,
      "linemod: distances from {} to {} m, expected a range from above 0 to below 60", settings.min_distance,
      settings.max_distance);
  require(settings.distance_step >= 1.01F && settings.distance_step <= 10.0F,
          "linemod: distance step {}, expected a factor from 1.01 to 10", settings.distance_step);
  require(settings.weak_gradient >= 0.0F && settings.weak_gradient < 1e4F,
          "linemod: weak gradient {}, expected 0 to 10000", settings.weak_gradient);
  require(settings.threads >= 1 && settings.threads <= 256, "linemod: {} threads, expected 1 to 256", settings.threads);
}

void check_view(const TrainingView& view) {
  check_frame(view.frame, view.source);
  require(view.mask.type() == CV_8UC1 && view.mask.size() == view.frame.colour.size(),
          "{}: mask of {}x{} pixels, expected 8 bit and {}x{} as the picture", view.source, view.mask.cols,
          view.mask.rows, view.frame.colour.cols, view.frame.colour.rows);
  const double z = view.T_camera_object.translation().z();
  require(std::isfinite(z) && z > 0.0, "{}: object at distance {} m, expected one in front of the camera", view.source,
          z);
}

}  // namespace

LinemodTemplates::LinemodTemplates(const std::vector<TrainingView>& views, const LinemodTemplateSettings& settings) {
  check_settings(settings);
  const std::vector<double> taught = distances(settings);
  std::vector<const TrainingView*> objects;
  for (const TrainingView& view : views) {
    if (view.class_id != 0) objects.push_back(&view);
  }
  for (int s = 0; s < settings.threads; ++s) shares_.emplace_back(settings);
  parallel_for(settings.threads, settings.threads, [&](int s) {
    LinemodShare& fraction = shares_[static_cast<std::size_t>(s)];
    for (auto v = static_cast<std::size_t>(s); v < objects.size(); v += shares_.size()) {
      check_view(*objects[v]);
      int made = 0;
      for (std::size_t d = 0; d < taught.size(); ++d) {
        made += fraction.add(*objects[v], taught[d], static_cast<int>(v * taught.size() + d)) ? 1 : 0;
      }
      if (made == 0) fraction.count_refused_view();
    }
  });
  for (const LinemodShare& fraction : shares_) {
    training_.templates += fraction.training().templates;
    training_.refused_templates += fraction.training().refused_templates;
    training_.refused_views += fraction.training().refused_views;
  }
  require(training_.templates > 0, "linemod: no template could be made of {} views, expected at least one",
          objects.size());
}

LinemodTemplates::~LinemodTemplates() = default;
LinemodTemplates::LinemodTemplates(LinemodTemplates&&) noexcept = default;

std::vector<LinemodMatch> LinemodTemplates::match(const RgbdFrame& frame, float threshold) const {
  check_frame(frame, "linemod");
  cv::Size largest;
  for (const LinemodShare& fraction : shares_) {
    largest = {std::max(largest.width, fraction.largest().width), std::max(largest.height, fraction.largest().height)};
  }
  const std::vector<cv::Mat> images = linemod_images(frame, largest);
  std::vector<std::vector<LinemodMatch>> parts(shares_.size());
  parallel_for(static_cast<int>(shares_.size()), static_cast<int>(shares_.size()), [&](int s) {
    const auto index = static_cast<std::size_t>(s);
    parts[index] = shares_[index].match(images, threshold);
  });
  std::vector<LinemodMatch> all;
  for (const std::vector<LinemodMatch>& part : parts) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end(), [](const LinemodMatch& a, const LinemodMatch& b) {
    return std::tuple(-a.similarity, a.shape->rank, a.at_px.y, a.at_px.x) <
           std::tuple(-b.similarity, b.shape->rank, b.at_px.y, b.at_px.x);
  });
  return all;
}

}  // namespace houghstream
