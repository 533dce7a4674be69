#pragma once

#include <string>

namespace houghstream {

/// Returns whether `a` comes before `b` when runs of digits compare as numbers: "desk_1_9" before "desk_1_28".
bool natural_less(const std::string& a, const std::string& b);

}  // namespace houghstream
