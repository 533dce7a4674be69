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

}  // namespace
}  // namespace houghstream::doctor
