#include "detector/profiles.hpp"

#include <gtest/gtest.h>

#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

float patch_reach(const Profile& profile) {
  return profile.patch.unit * static_cast<float>(profile.patch.radius);
}

TEST(Profiles, UnknownNamesAreRefused) {
  EXPECT_THROW(make_profile("fast"), InputError);
  Profile profile = make_profile("gall");
  EXPECT_THROW(set_scale_handling(profile, "seven"), InputError);
}

TEST(Profiles, PatchesOfAScaleSpaceShrinkWithTheImage) {
  Profile profile = make_profile("gall");
  const float smoothing = profile.detection.vote_sigma;
  set_image_scale(profile, 0.5F);
  EXPECT_EQ(profile.features.image_scale, 0.5F);
  EXPECT_EQ(profile.patch.radius, 4);
  set_scale_handling(profile, "five");
  EXPECT_EQ(profile.patch.unit, 1.0F);
  EXPECT_EQ(profile.detection.vote_sigma, smoothing);  // counted as on an object at 1 m
}

TEST(Profiles, PatchesOfTheTiniestImageHaveAnExtent) {
  Profile profile = make_profile("gall");
  set_image_scale(profile, 0.01F);
  EXPECT_EQ(profile.patch.radius, 1);
}

TEST(Profiles, DepthNormalisedPatchesCoverTheSameSurfaceInAnyImageSize) {
  for (const char* name : {"paper", "realtime"}) {
    Profile profile = make_profile(name);
    const float reach = patch_reach(profile);
    set_image_scale(profile, 0.25F);
    EXPECT_EQ(patch_reach(profile), reach) << name;
  }
  Profile whole = make_profile("gall");
  set_scale_handling(whole, "normalised");
  Profile half = make_profile("gall");
  set_image_scale(half, 0.5F);
  set_scale_handling(half, "normalised");
  EXPECT_FLOAT_EQ(patch_reach(half), patch_reach(whole));
}

}  // namespace
}  // namespace houghstream
