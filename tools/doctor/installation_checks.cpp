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

/// Returns the words of the first line of proc/cpuinfo that begins with the key.
std::string cpu_line(const std::string& cpuinfo, const std::string& key) {
  std::istringstream lines(cpuinfo);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(key, 0) == 0) return line.substr(line.find(':') + 1) + " ";
  }
  return "";
}

int count_processors(const std::string& cpuinfo) {
  std::istringstream lines(cpuinfo);
  int count = 0;
  for (std::string line; std::getline(lines, line);) count += line.rfind("processor", 0) == 0 ? 1 : 0;
  return count;
}

Finding check_processor(const Machine& machine) {
  const std::string cpuinfo = machine.read("proc/cpuinfo");
  const int processors = count_processors(cpuinfo);
  const std::string flags = cpu_line(cpuinfo, "flags");
  const bool is_x86 = !flags.empty();
  if (processors < 2) {
    return note("processor", fmt::format("{} processor, two are wanted: detection takes twice as long", processors));
  }
  if (is_x86 && flags.find(" avx2 ") == std::string::npos) {
    return note("processor", fmt::format("{} processors without AVX2: detection is slower", processors));
  }
  return ok("processor", fmt::format("{} processors{}", processors, is_x86 ? " with AVX2" : ""));
}

Finding check_lcm_tools(const Machine& machine) {
  for (const char* name : {"lcm-logger", "lcm-logplayer"}) {
    if (!machine.find_program(name)) {
      return note("LCM's tools", fmt::format("no {}: logs cannot be recorded and replayed", name),
                  "sudo apt-get install liblcm-bin");
    }
  }
  return ok("LCM's tools", "lcm-logger, lcm-logplayer");
}

Finding check_java(const Machine& machine) {
  const std::optional<fs::path> java = machine.find_program("java");
  if (!java) return note("Java", "not there: no lcm-spy", "sudo apt-get install default-jre");
  if (!machine.runs(*java, "-version")) {
    return note("Java", "java does not run: no lcm-spy", "sudo apt-get install --reinstall default-jre");
  }
  return ok("Java", "java runs");
}

Finding check_spy(const Machine& machine, const fs::path& types_jar) {
  for (const auto& [jar, package] : {std::pair{"lcm.jar", "liblcm-java"}, {"jchart2d.jar", "libjchart2d-java"}}) {
    bool there = false;
    for (const char* folder : {"usr/share/java", "usr/local/share/java"}) {
      there = there || fs::exists(machine.root / folder / jar);
    }
    if (!there) {
      return note("lcm-spy", fmt::format("no {} in /usr/share/java: lcm-spy does not start", jar),
                  fmt::format("sudo apt-get install {}", package));
    }
  }
  if (!fs::exists(types_jar)) {
    return note("lcm-spy", fmt::format("no {}: lcm-spy shows ?? for our types", types_jar.string()),
                "sudo apt-get install default-jdk-headless && cmake -S . -B build && cmake --build build");
  }
  return ok("lcm-spy", "lcm.jar, jchart2d.jar, and our types");
}

Finding check_display(const Machine& machine) {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const std::string value = machine.environment(name);
    if (!value.empty()) return ok("display", fmt::format("{}={}", name, value));
  }
  return note("display", "none: hs-view opens no window", "hs-view --http 8080, or --snapshot FILE.png");
}

namespace fs = std::filesystem;

/// Returns the path without symbolic links, since /bin is /usr/bin.
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
  const fs::path program_folder = resolved(programs);
  const std::vector<fs::path> folders = folders_with_programs(machine);
  const auto other =
      std::find_if(folders.begin(), folders.end(), [&](const fs::path& folder) { return folder != program_folder; });
  if (other == folders.end())
    return ok("programs", fmt::format("those in {}, no others on $PATH", shown(machine, program_folder)));
  const std::string place = shown(machine, *other);
  return note("programs",
              fmt::format("others in {}{}: processes of two versions need not understand each other", place,
                          other == folders.begin() ? ", which the shell starts" : ""),
              place == "/usr/bin" ? "sudo apt-get remove houghstream" : fmt::format("sudo rm '{}'/hs-*", place));
}

/// Returns the folders in which Debian's Python looks for packages, in its order.
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

/// Returns the folders that hold it.
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

Findings check_tools(const Machine& machine, const fs::path& types_jar) {
  return {check_processor(machine), check_lcm_tools(machine), check_java(machine), check_spy(machine, types_jar),
          check_display(machine)};
}

Findings check_installation(const Machine& machine, const fs::path& programs) {
  return {check_programs(machine, programs), check_python(machine, programs)};
}

}  // namespace houghstream::doctor
