#include "detector/features/feature_families.hpp"

#include <sstream>

#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

std::string all_names() {
  std::string names;
  for (const FamilyName& known : kFamilyNames) names += (names.empty() ? "" : ", ") + std::string(known.name);
  return names;
}

FeatureBlock block_of(FeatureFamily family) {
  switch (family) {
    case kIntensity: return {family, 0, 16, true};
    case kDepthValue: return {family, 0, 1, true};
    case kDepthDerivatives: return {family, 0, 4, true};
    case kDepthHog: return {family, 0, 9, true};
    case kHonv: return {family, 0, 12, false};
    case kCurvature: return {family, 0, 5, true};
    case kPointHistogram: return {family, 0, 125, false};
    case kFastHistogram: return {family, 0, 33, false};
  }
  fail("feature family {}, expected one of {}", static_cast<std::uint32_t>(family), all_names());
}

PlaneKind kind_of(FeatureFamily family, ScaleHandling handling) {
  if (family == kIntensity) return PlaneKind::kIntensity;
  if (family == kPointHistogram || family == kFastHistogram) return PlaneKind::kHistogram;
  if (family != kDepthValue) return PlaneKind::kSurface;
  return handling == ScaleHandling::kDepthNormalised ? PlaneKind::kWrappedDepth : PlaneKind::kScaledDepth;
}

}  // namespace

std::uint32_t parse_families(const std::string& names) {
  std::uint32_t families = 0;
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    std::uint32_t found = 0;
    for (const FamilyName& known : kFamilyNames) found |= name == known.name ? known.family : 0U;
    require(found != 0, "feature '{}', expected some of {}", name, all_names());
    families |= found;
  }
  require(families != 0, "features '{}', expected some of {}", names, all_names());
  return families;
}

std::string family_names(std::uint32_t families) {
  std::string names;
  for (const FamilyName& known : kFamilyNames) {
    if ((families & known.family) != 0) names += (names.empty() ? "" : ",") + std::string(known.name);
  }
  return names;
}

FeatureLayout::FeatureLayout(const FeatureSettings& settings) {
  for (const FamilyName& known : kFamilyNames) {
    if ((settings.families & known.family) == 0) continue;
    FeatureBlock block = block_of(known.family);
    block.first = planes_;
    planes_ += block.planes();
    kinds_.resize(static_cast<std::size_t>(planes_), kind_of(known.family, settings.handling));
    blocks_.push_back(block);
  }
}

const FeatureBlock& FeatureLayout::block(FeatureFamily family) const {
  for (const FeatureBlock& block : blocks_) {
    if (block.family == family) return block;
  }
  fail("features: no '{}' in this layout, expected it among its families", family_names(family));
}

void check_settings(const FeatureSettings& settings, const std::string& source) {
  check_fields(settings, source);
  require(settings.families > 0 && settings.families <= kAllFamilies && FeatureLayout(settings).planes() < 256,
          "{}: families {:#x}, expected some of {:#x}", source, settings.families, kAllFamilies);
  const bool is_scale_space = settings.handling == ScaleHandling::kScaleSpace;
  require(is_scale_space || settings.handling == ScaleHandling::kDepthNormalised,
          "{}: handling {}, expected 0 for depth normalisation or 1 for a scale space", source,
          static_cast<std::uint32_t>(settings.handling));
  require(!is_scale_space || settings.scales[0] > 0.0F, "{}: a scale space without scales, expected at least one",
          source);
  for (const float scale : settings.scales) {
    require(scale == 0.0F || (scale >= 0.05F && scale <= 8.0F), "{}: scales hold {}, expected 0.05 to 8", source,
            scale);
  }
  require(settings.depth_sobel_px % 2 == 1, "{}: depth_sobel_px {}, expected an odd number of working pixels", source,
          settings.depth_sobel_px);
}

}  // namespace houghstream
