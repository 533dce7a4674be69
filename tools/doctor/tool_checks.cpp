#include "tools/doctor/tool_checks.hpp"

#include <fmt/format.h>

#include <sstream>

namespace houghstream::doctor {
namespace {

namespace fs = std::filesystem;

/// Words of the first line of proc/cpuinfo that begins so.
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

}  // namespace

Findings check_tools(const Machine& machine, const fs::path& types_jar) {
  return {check_processor(machine), check_lcm_tools(machine), check_java(machine), check_spy(machine, types_jar),
          check_display(machine)};
}

}  // namespace houghstream::doctor
