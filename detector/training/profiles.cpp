#include "detector/training/profiles.hpp"

#include "detector/features/working_frame.hpp"

namespace houghstream {
namespace {

void look_as_the_paper(Profile& profile) {
  profile.features.image_scale = 0.7F;
  profile.features.far_distance = profile.features.max_distance;  // one size for all
  profile.patch.radius = 5;
  profile.patch.unit = 1.0F / (0.7F * kReferenceFocal_px);  // one working pixel at 1 m
}

}  // namespace

Profile make_profile(const std::string& name) {
  Profile profile;
  profile.name = name;
  profile.detection = detection_settings(name);
  if (name == kPaperProfile) look_as_the_paper(profile);
  return profile;
}

}  // namespace houghstream
