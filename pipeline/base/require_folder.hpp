#pragma once

#include <filesystem>
#include <string>

#include "pipeline/base/checks.hpp"

namespace houghstream {

/// Throws InputError unless `folder` is one; the line says whether nothing or a file is there. `expected` is what was
/// to be found, "models".
inline void require_folder(const std::filesystem::path& folder, const std::string& expected) {
  std::error_code unknown;
  if (std::filesystem::is_directory(folder, unknown)) return;
  const bool is_file = std::filesystem::exists(folder, unknown);
  fail("{}: {}, expected {}", folder.string(), is_file ? "is a file" : "no such folder",
       is_file ? "a folder: " + expected : expected);
}

}  // namespace houghstream
