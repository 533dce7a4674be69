#pragma once

#include <string>
#include <vector>

#include "tools/studies/pose/pose_trial.hpp"

namespace houghstream {

/// The first line of poses.csv.
std::string pose_table_header();

/// A line for each trial; `variant` says who made the poses. What is not known is left empty.
std::string pose_table_rows(const std::string& variant, const std::vector<PoseTrial>& trials);

}  // namespace houghstream
