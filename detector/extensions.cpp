#include "detector/extensions.hpp"

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

Extensions& installed() {
  static Extensions extensions;
  return extensions;
}

}  // namespace

void extend_detector(const Extensions& extensions) {
  installed() = extensions;
}

const Extensions& extensions() {
  return installed();
}

void require_extensions(const FeatureSettings& settings, const std::string& source) {
  const bool in_scale_space = settings.handling == ScaleHandling::kScaleSpace;
  require(!in_scale_space || extensions().search_scale_space != nullptr,
          "{}: searches several sizes of the image, which this program cannot, expected one with {}", source,
          kBaselineFolder);
  std::uint32_t surfaces = 0;
  for (const FamilyName& known : kFamilyNames) {
    if (is_surface_family(known.family)) surfaces |= settings.families & known.family;
  }
  require(surfaces == 0 || extensions().surface_planes != nullptr,
          "{}: has the features '{}', which this program cannot compute, expected one with {}", source,
          family_names(surfaces), kBaselineFolder);
}

}  // namespace houghstream
