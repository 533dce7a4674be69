#include "pipeline/base/cache_folder.hpp"

#include <cstdlib>

#include "pipeline/base/checks.hpp"

namespace houghstream {

std::filesystem::path cache_folder(const char* instead) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache != '\0') return std::filesystem::path(cache) / "houghstream";
  const char* home = std::getenv("HOME");
  require(home != nullptr && *home != '\0', "neither XDG_CACHE_HOME nor HOME is set, expected {}", instead);
  return std::filesystem::path(home) / ".cache" / "houghstream";
}

}  // namespace houghstream
