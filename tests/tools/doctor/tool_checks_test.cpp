#include "tools/doctor/tool_checks.hpp"

#include <gtest/gtest.h>

#include "tests/tools/doctor/healthy_machine.hpp"

namespace houghstream::doctor {
namespace {

using Level = Finding::Level;

Finding processor_of(const std::string& cpuinfo) {
  const HealthyMachine healthy("tools_processor");
  plant(healthy.machine.root / "proc/cpuinfo", cpuinfo);
  return check_tools(healthy.machine, healthy.settings.types_jar).front();
}

TEST(ToolChecks, ProcessorsAreCountedAndAvx2IsAWholeWord) {
  const std::string two = "processor : 0\nprocessor : 1\n";
  EXPECT_EQ(processor_of(two + "flags : avx avx2\n").what, "2 processors with AVX2");
  EXPECT_EQ(processor_of(two + "flags : avx avx2_other\n").level, Level::kNote);
  EXPECT_EQ(processor_of(two + "Features : asimd\n").what, "2 processors");  // not of the x86 kind
  EXPECT_EQ(processor_of("processor : 0\nflags : avx2\n").level, Level::kNote);
  EXPECT_EQ(processor_of("").level, Level::kNote);
}

TEST(ToolChecks, NothingThatIsMissingIsWrong) {
  Machine bare;
  bare.root = fresh_folder("tools_bare");
  bare.environment = [](const std::string&) { return ""; };
  const Findings findings = check_tools(bare, bare.root / "types.jar");
  ASSERT_EQ(findings.size(), 5U);
  for (const Finding& finding : findings) EXPECT_EQ(finding.level, Level::kNote) << finding.name;
}

TEST(ToolChecks, JavaIsStartedWhereThePathHasIt) {
  HealthyMachine healthy("tools_java");
  std::string started;
  healthy.machine.runs = [&](const std::filesystem::path& program, const std::string& argument) {
    started = program.lexically_relative(healthy.machine.root).string() + " " + argument;
    return true;
  };
  check_tools(healthy.machine, healthy.settings.types_jar);
  EXPECT_EQ(started, "usr/bin/java -version");
}

TEST(ToolChecks, EachJarAndEitherDisplayWillDo) {
  HealthyMachine healthy("tools_jars");
  const std::filesystem::path java = healthy.machine.root / "usr/share/java";
  plant(healthy.machine.root / "usr/local/share/java/lcm.jar");
  std::filesystem::remove(java / "lcm.jar");
  healthy.machine.environment = [](const std::string& name) -> std::string {
    return name == "PATH" ? "/usr/bin" : name == "WAYLAND_DISPLAY" ? "wayland-0" : "";
  };
  Findings findings = check_tools(healthy.machine, healthy.settings.types_jar);
  EXPECT_EQ(findings[3].level, Level::kOk) << findings[3].what;
  EXPECT_EQ(findings[4].what, "WAYLAND_DISPLAY=wayland-0");
  std::filesystem::remove(java / "jchart2d.jar");
  findings = check_tools(healthy.machine, healthy.settings.types_jar);
  EXPECT_EQ(findings[3].remedy, "sudo apt-get install libjchart2d-java");
}

}  // namespace
}  // namespace houghstream::doctor
