#include "tools/doctor/installation_checks.hpp"

#include <gtest/gtest.h>

#include "tests/tools/doctor/healthy_machine.hpp"

namespace houghstream::doctor {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

Finding programs_of(const HealthyMachine& machine) {
  return check_installation(machine.machine, machine.settings.programs).front();
}

Finding python_of(const HealthyMachine& machine) {
  return check_installation(machine.machine, machine.settings.programs).back();
}

TEST(InstallationChecks, OtherProgramsOnThePathAreNamed) {
  const HealthyMachine healthy("installation_others");
  plant(healthy.machine.root / "usr/local/bin/hs-detect");
  EXPECT_EQ(programs_of(healthy).level, Level::kNote);
  EXPECT_NE(programs_of(healthy).what.find("others in /usr/local/bin, which the shell starts"), std::string::npos)
      << programs_of(healthy).what;
  EXPECT_EQ(programs_of(healthy).remedy, "sudo rm '/usr/local/bin'/hs-*");
}

TEST(InstallationChecks, AnInstallationBesideOneOfThePackageIsNamed) {
  HealthyMachine healthy("installation_package");
  plant(healthy.machine.root / "usr/bin/hs-detect");
  plant(healthy.machine.root / "usr/local/bin/hs-detect");
  healthy.settings.programs = healthy.machine.root / "usr/local/bin";
  EXPECT_EQ(programs_of(healthy).remedy, "sudo apt-get remove houghstream");
  EXPECT_EQ(programs_of(healthy).what.find("which the shell starts"), std::string::npos);
}

TEST(InstallationChecks, AFolderByTwoNamesIsOne) {
  HealthyMachine healthy("installation_links");
  plant(healthy.machine.root / "usr/bin/hs-detect");
  fs::create_directory_symlink("usr/bin", healthy.machine.root / "bin");
  healthy.machine.environment = [](const std::string& name) { return name == "PATH" ? "/bin:/usr/bin" : ""; };
  healthy.settings.programs = healthy.machine.root / "usr/bin";
  EXPECT_EQ(programs_of(healthy).level, Level::kOk) << programs_of(healthy).what;
}

TEST(InstallationChecks, OfTwoPythonPackagesTheOneThatIsTakenIsNamed) {
  const HealthyMachine healthy("installation_python");
  plant(healthy.machine.root / "usr/local/lib/python3.11/dist-packages/houghstream/event_log.py");
  const Finding found = python_of(healthy);
  EXPECT_EQ(found.level, Level::kNote);
  EXPECT_EQ(found.remedy, "sudo rm -r /usr/local/lib/python3.11/dist-packages/houghstream");
}

TEST(InstallationChecks, APackageThatIsBuiltButNotInstalledWillDo) {
  const HealthyMachine healthy("installation_built");
  const fs::path package = healthy.machine.root / "usr/lib/python3/dist-packages/houghstream";
  fs::remove_all(package);
  EXPECT_EQ(python_of(healthy).level, Level::kNote);
  plant(healthy.machine.root / "build/python/houghstream/event_log.py");
  EXPECT_EQ(python_of(healthy).level, Level::kOk);
  EXPECT_NE(python_of(healthy).what.find("PYTHONPATH=/build/python"), std::string::npos) << python_of(healthy).what;
}

TEST(InstallationChecks, WithoutTheLcmModulePythonReadsLogsOnly) {
  const HealthyMachine healthy("installation_lcm");
  EXPECT_EQ(python_of(healthy).what.find("logs only"), std::string::npos);
  fs::remove_all(healthy.machine.root / "usr/lib/python3/dist-packages/lcm");
  EXPECT_EQ(python_of(healthy).level, Level::kOk);
  EXPECT_NE(python_of(healthy).what.find("logs only"), std::string::npos);
}

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
