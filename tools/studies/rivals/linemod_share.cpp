#include "tools/studies/rivals/linemod_share.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "tools/studies/rivals/linemod_image.hpp"
#include "tools/studies/rivals/scaled_view.hpp"

namespace houghstream {
namespace {

const char* const kOneClass = "object";  // classes are told apart by our own list of templates

cv::Ptr<cv::linemod::Detector> new_linemod(const LinemodTemplateSettings& settings) {
  const auto features = static_cast<std::size_t>(settings.features);
  const int farthest_mm = static_cast<int>(settings.max_distance * 1000.0F) + 500;
  // What is not set is as cv::linemod has it by default.
  constexpr float kStrongGradient = 55.0F;
  const std::vector<cv::Ptr<cv::linemod::Modality>> modalities = {
      cv::makePtr<cv::linemod::ColorGradient>(settings.weak_gradient, features, kStrongGradient),
      cv::makePtr<cv::linemod::DepthNormal>(farthest_mm, 50, features, 2)};
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
  LinemodTemplate made{view.class_id, view.class_name, static_cast<float>(distance), {}, {}, {}, rank};
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

}  // namespace houghstream
