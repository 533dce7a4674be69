#include "tools/doctor/installation_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tools/doctor/openni_folder.hpp"

namespace houghstream::doctor {
namespace {

namespace fs = std::filesystem;

/// Without symbolic links: /bin is /usr/bin.
fs::path resolved(const fs::path& path) {
  std::error_code unknown;
  const fs::path whole = fs::weakly_canonical(path, unknown);
  return unknown ? path : whole;
}

/// The folders of $PATH that hold our programs, in its order, each once.
std::vector<fs::path> folders_with_programs(const Machine& machine) {
  std::vector<fs::path> folders;
  std::istringstream path(machine.environment("PATH"));
  for (std::string name; std::getline(path, name, ':');) {
    if (name.empty() || name.front() != '/') continue;
    const fs::path folder = resolved(machine.root / name.substr(1));
    std::error_code unknown;
    const bool is_new = std::find(folders.begin(), folders.end(), folder) == folders.end();
    if (is_new && fs::is_regular_file(folder / "hs-detect", unknown)) folders.push_back(folder);
  }
  return folders;
}

Finding check_programs(const Machine& machine, const fs::path& programs) {
  const fs::path own = resolved(programs);
  const std::vector<fs::path> folders = folders_with_programs(machine);
  const auto other =
      std::find_if(folders.begin(), folders.end(), [&](const fs::path& folder) { return folder != own; });
  if (other == folders.end())
    return ok("programs", fmt::format("those in {}, no others on $PATH", shown(machine, own)));
  const std::string place = shown(machine, *other);
  return note("programs",
              fmt::format("others in {}{}: processes of two versions need not understand each other", place,
                          other == folders.begin() ? ", which the shell starts" : ""),
              place == "/usr/bin" ? "sudo apt-get remove houghstream" : fmt::format("sudo rm '{}'/hs-*", place));
}

/// Where Debian's Python looks for packages, in its order.
std::vector<fs::path> python_folders(const Machine& machine) {
  std::vector<fs::path> folders;
  std::error_code unknown;
  for (const auto& entry : fs::directory_iterator(machine.root / "usr/local/lib", unknown)) {
    if (entry.path().filename().string().rfind("python3.", 0) == 0) folders.push_back(entry.path() / "dist-packages");
  }
  std::sort(folders.begin(), folders.end());
  folders.push_back(machine.root / "usr/lib/python3/dist-packages");
  return folders;
}

/// Those of the folders that hold it.
std::vector<fs::path> folders_with(const char* package, const std::vector<fs::path>& folders) {
  std::vector<fs::path> found;
  std::copy_if(folders.begin(), folders.end(), std::back_inserter(found), [&](const fs::path& folder) {
    std::error_code unknown;
    return fs::exists(folder / package, unknown);
  });
  return found;
}

Finding check_python(const Machine& machine, const fs::path& programs) {
  const char* const ours = "houghstream/event_log.py";
  const std::vector<fs::path> folders = python_folders(machine);
  const std::vector<fs::path> installed = folders_with(ours, folders);
  const std::vector<fs::path> built = folders_with(ours, {programs.parent_path() / "python"});
  if (installed.empty() && built.empty()) {
    return note("Python", "no package houghstream: Python reads neither messages nor logs",
                "sudo apt-get install ./build/packages/python3-houghstream_*.deb");
  }
  if (installed.size() > 1) {
    const std::string first = shown(machine, installed.front());
    return note("Python",
                fmt::format("two packages houghstream: that in {} is taken, that in {} is not", first,
                            shown(machine, installed.back())),
                fmt::format("sudo rm -r {}/houghstream", first));
  }
  for (const auto& [needed, package] : {std::pair{"numpy", "python3-numpy"}, {"PIL", "python3-pil"}}) {
    if (!folders_with(needed, folders).empty()) continue;
    return note("Python", fmt::format("no {}: frames do not become arrays", needed),
                fmt::format("sudo apt-get install {}", package));
  }
  const bool hears = !folders_with("lcm", folders).empty();
  const std::string where = installed.empty() ? "PYTHONPATH=" + shown(machine, built.front()) + " has it"
                                              : "in " + shown(machine, installed.front());
  return ok("Python",
            fmt::format("package houghstream, {}{}", where, hears ? "" : "; without a module lcm: logs only"));
}

}  // namespace

Findings check_installation(const Machine& machine, const fs::path& programs) {
  return {check_programs(machine, programs), check_python(machine, programs)};
}

}  // namespace houghstream::doctor
