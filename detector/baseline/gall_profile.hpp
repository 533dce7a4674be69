#pragma once

#include <string>
#include <vector>

#include "detector/training/profiles.hpp"

namespace houghstream::baseline {

/// Makes the profile of the original Hough Forest (Gall et al. 2011) with the parameters of the paper's Section 4:
/// intensity only, five scales of the image, patches of 16x16 pixels, every pixel; a detection's score is its votes'
/// mass. A patch votes for the objects that it takes for likelier than one of so many by chance. `objects`: how many
/// are taught.
Profile gall_profile(std::size_t objects);

/// Makes a profile as houghstream::make_profile does, but knows "gall" too. The paper teaches four objects.
Profile make_profile(const std::string& name, std::size_t objects = 4);

std::vector<std::string> profile_names();

/// Returns the settings of the profile that the forest was trained with, for its number of objects.
DetectionSettings detection_settings_of(const Forest& forest);

/// Returns the profile by which a forest was trained, see training::profile_of.
Profile profile_of(const Forest& forest);

/// Sets the working size over the frame size (paper, Section 5.1.1). Lengths in pixels, patches above all, are
/// adjusted, so that they cover as much of the frame as before; lengths in metres stay. It is to be called before
/// set_scale_handling.
void set_image_scale(Profile& profile, float image_scale);

/// Sets the handling of distances: "five" (scales, Gall et al. 2011), "single" (scale 1 only) or "normalised" (by
/// depth, Section 5.1.2; patches as large as at 1 m, about where turntables stand). Throws InputError for another word.
void set_scale_handling(Profile& profile, const std::string& handling);

}  // namespace houghstream::baseline
