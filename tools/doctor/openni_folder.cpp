#include "tools/doctor/openni_folder.hpp"

#include <algorithm>
#include <sstream>

#include "tools/common/trimmed.hpp"

namespace houghstream::doctor {
namespace {

namespace fs = std::filesystem;

const std::string kRightEnd = ".so.0";

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Returns "libPS1080" for libPS1080.so.0.
std::string stem_of(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.substr(0, name.find(".so"));
}

}  // namespace

std::optional<fs::path> find_openni(const Machine& machine) {
  std::vector<std::string> folders;
  std::istringstream library_path(machine.environment("LD_LIBRARY_PATH"));
  for (std::string folder; std::getline(library_path, folder, ':');) {
    if (!folder.empty() && folder.front() == '/') folders.push_back(folder.substr(1));
  }
  for (const char* folder : {"usr/local/lib", "usr/lib/x86_64-linux-gnu", "usr/lib/aarch64-linux-gnu", "usr/lib"}) {
    folders.emplace_back(folder);
  }
  for (const std::string& folder : folders) {
    const fs::path library = machine.root / folder / "libOpenNI2.so.0";
    std::error_code error;
    if (fs::exists(library, error)) return library;
  }
  return std::nullopt;
}

fs::path driver_folder(const Machine& machine, const fs::path& library) {
  const std::string key = "Repository=";
  std::istringstream lines(machine.read("etc/openni2/OpenNI.ini"));
  for (std::string line; std::getline(lines, line);) {
    const std::string text = trimmed(line);
    if (text.rfind(key, 0) != 0) continue;
    const fs::path folder = trimmed(text.substr(key.size()));
    return folder.is_absolute() ? machine.root / folder.relative_path() : library.parent_path() / folder;
  }
  return library.parent_path() / "OpenNI2" / "Drivers";
}

Drivers list_drivers(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("lib", 0) == 0 && name.find(".so") != std::string::npos) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  Drivers drivers;
  for (const fs::path& file : files) {
    if (ends_with(file.string(), kRightEnd)) drivers.named_right.push_back(file);
  }
  for (const fs::path& file : files) {
    const auto same = [&](const fs::path& other) { return stem_of(other) == stem_of(file); };
    const auto& right = drivers.named_right;
    if (std::none_of(right.begin(), right.end(), same)) drivers.named_wrong.push_back(file);
  }
  return drivers;
}

std::string shown(const Machine& machine, const fs::path& path) {
  return "/" + path.lexically_relative(machine.root).string();
}

}  // namespace houghstream::doctor
