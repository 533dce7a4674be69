#pragma once

#include "tools/teach/mesh/teach_jobs.hpp"
#include "tools/teach/show/show_options.hpp"
#include "tools/teach/show/show_report.hpp"

namespace houghstream::teach {

/// What teaches a shown object: its mesh as one that hs-teach mesh could have read, and the keyframes' views of it, all
/// in the tone in which objects are looked for. Throws InputError for a mesh that cannot be taught.
TeachOptions options_to_teach(const ShowOptions& options, const ShowResult& shown);

}  // namespace houghstream::teach
