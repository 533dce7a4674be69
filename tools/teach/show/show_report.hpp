#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pose/reconstruction/take_model.hpp"

namespace houghstream::teach {

/// What is judged: takes that were followed, and the model of all of them.
struct Shown {
  std::string name;
  std::vector<reconstruction::Take> takes;
  std::vector<std::vector<reconstruction::ShownView>> views;  ///< of each take
  Mesh mesh;
  double seen_surface = 0.0;  ///< share of the closed surface that some view shows
  bool second_fits = true;    ///< the second take, where there was one
  double agreement_m = 0.0;
  double seen_through = 0.0;              ///< reconstruction::seen_through_share()
  std::optional<double> outline_overlap;  ///< median over the views, with masks that were given
  double seconds = 0.0;                   ///< that it took until the model was there
};

/// Share of vertices.
double share_of_seen(const std::vector<bool>& seen);

/// Whether a model is worth teaching.
struct Verdict {
  bool good = true;
  std::vector<std::string> reasons;  ///< why not, a line each
};

/// Of all takes that were merged, and of the model.
Verdict judge(const Shown& shown);

/// Second of the take at which a frame was taken.
double second_of(const reconstruction::Take& take, int frame);

/// The verdict and its figures in words, a few lines.
std::string describe(const Shown& shown, const Verdict& verdict);

/// Throws InputError where a folder holds something else than what was kept of an earlier showing, and would not be
/// replaced, or could not be written.
void require_keepable(const std::filesystem::path& folder);

/// What was asked to be kept, in a folder that appears as a whole: model.ply, views/ (BOP: the keyframes with poses and
/// masks), contact_sheet.jpg, chosen.png, outlines/, camera_poses.csv, report.json and report.html. One of an earlier
/// time is replaced, anything else is not. Throws InputError where it cannot be written.
void keep_shown(const Shown& shown, const Verdict& verdict, const std::filesystem::path& folder);

}  // namespace houghstream::teach
