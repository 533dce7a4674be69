#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/teach/show/show_report.hpp"

namespace houghstream::teach {

/// Throws InputError where a folder holds something else than what was kept of an earlier showing, and would not be
/// replaced, or could not be written.
void require_keepable(const std::filesystem::path& folder);

/// Archives the session in a folder that is committed atomically: model.ply, views/ (BOP: the keyframes with poses and
/// masks), contact_sheet.jpg, chosen.png, outlines/, camera_poses.csv, report.json and report.html. One of an earlier
/// time is replaced, anything else is not. Throws InputError where it cannot be written.
void archive_session(const ShowResult& shown, const ModelAssessment& assessment, const std::filesystem::path& folder);

/// Files beside report.html that it shows.
struct SessionImages {
  std::vector<std::string> selected;  ///< keyframes of each take
  std::vector<std::string> outlines;  ///< outlines of some keyframes
};

/// Returns report.html. Names are shown as they are, whatever they hold.
std::string report_page(const ShowResult& shown, const ModelAssessment& assessment, const SessionImages& images);

}  // namespace houghstream::teach
