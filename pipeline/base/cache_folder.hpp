#pragma once

#include <filesystem>

namespace houghstream {

/// Returns the folder in which programs cache what they can make again: $XDG_CACHE_HOME/houghstream, or
/// ~/.cache/houghstream. It need not exist yet. Throws InputError, naming the option `instead`, where neither
/// XDG_CACHE_HOME nor HOME is set.
std::filesystem::path cache_folder(const char* instead);

}  // namespace houghstream
