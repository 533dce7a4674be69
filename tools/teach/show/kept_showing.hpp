#pragma once

#include <filesystem>

#include "tools/teach/show/show_report.hpp"

namespace houghstream::teach {

/// Throws InputError where a folder holds something else than what was kept of an earlier showing, and would not be
/// replaced, or could not be written.
void require_keepable(const std::filesystem::path& folder);

/// What was asked to be kept, in a folder that appears as a whole: model.ply, views/ (BOP: the keyframes with poses and
/// masks), contact_sheet.jpg, chosen.png, outlines/, camera_poses.csv, report.json and report.html. One of an earlier
/// time is replaced, anything else is not. Throws InputError where it cannot be written.
void keep_shown(const Shown& shown, const Verdict& verdict, const std::filesystem::path& folder);

}  // namespace houghstream::teach
