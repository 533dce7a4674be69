#pragma once

#include <string>

#include "tools/teach/show/show_options.hpp"
#include "tools/teach/show/show_report.hpp"

namespace houghstream::teach {

/// Returns whether a source is uw:DIR of one instance's turntable videos in the layout of the UW RGB-D Object Dataset:
/// DIR/INSTANCE_V_N_crop.png with depth, mask and position.
bool is_turntable_videos(const std::string& source);

/// Makes the model of the videos: poses from the turntable's axis, or from registration of the views to one another
/// where that agrees better; the videos are laid on one another and merged. `options.camera` is that of the whole
/// images, else the dataset's nominal one. Throws InputError where there is nothing to fuse.
ShowResult show_turntable(const ShowOptions& options);

}  // namespace houghstream::teach
