#include "tools/doctor/openni_folder.hpp"

#include <gtest/gtest.h>

#include "tests/tools/doctor/healthy_machine.hpp"

namespace houghstream::doctor {
namespace {

namespace fs = std::filesystem;

TEST(OpenniFolder, TheLibraryPathComesBeforeTheSystemsFolders) {
  HealthyMachine healthy("openni_found");
  EXPECT_EQ(find_openni(healthy.machine), healthy.openni_library());
  const fs::path own = healthy.machine.root / "opt/mine/libOpenNI2.so.0";
  plant(own);
  healthy.machine.environment = [](const std::string& name) {
    return name == "LD_LIBRARY_PATH" ? ":relative:/empty:/opt/mine" : "";
  };
  EXPECT_EQ(find_openni(healthy.machine), own);
  fs::remove(own);
  fs::remove(healthy.openni_library());
  EXPECT_EQ(find_openni(healthy.machine), std::nullopt);
}

TEST(OpenniFolder, DriversLieBesideTheLibraryUnlessTheIniFileSaysWhere) {
  const HealthyMachine healthy("openni_ini");
  const fs::path ini = healthy.machine.root / "etc/openni2/OpenNI.ini";
  EXPECT_EQ(driver_folder(healthy.machine, healthy.openni_library()), healthy.drivers());
  plant(ini, "[Drivers]\n;Repository=/commented/out\n");
  EXPECT_EQ(driver_folder(healthy.machine, healthy.openni_library()), healthy.drivers());
  plant(ini, "[Drivers]\r\n  Repository= /opt/drivers \r\n");
  EXPECT_EQ(driver_folder(healthy.machine, healthy.openni_library()), healthy.machine.root / "opt/drivers");
  plant(ini, "Repository=mine/too\n");
  EXPECT_EQ(driver_folder(healthy.machine, healthy.openni_library()),
            healthy.openni_library().parent_path() / "mine/too");
}

TEST(OpenniFolder, DriversWithAnotherEndAreNamedWrongUnlessTheRightOneIsThere) {
  const fs::path folder = fresh_folder("openni_names");
  for (const char* name : {"libB.so", "libB.so.0", "libA.so.0", "libC.so.1", "libD.so", "readme.txt", "other.so.0"}) {
    plant(folder / name);
  }
  const Drivers drivers = list_drivers(folder);
  EXPECT_EQ(drivers.named_right, (std::vector<fs::path>{folder / "libA.so.0", folder / "libB.so.0"}));
  EXPECT_EQ(drivers.named_wrong, (std::vector<fs::path>{folder / "libC.so.1", folder / "libD.so"}));
  const Drivers none = list_drivers(folder / "nowhere");
  EXPECT_TRUE(none.named_right.empty() && none.named_wrong.empty());
}

TEST(OpenniFolder, PathsAreShownAsUsersKnowThem) {
  Machine machine;
  machine.root = "/tmp/test";
  EXPECT_EQ(shown(machine, "/tmp/test/usr/lib"), "/usr/lib");
  machine.root = "/";
  EXPECT_EQ(shown(machine, "/usr/lib"), "/usr/lib");
}

}  // namespace
}  // namespace houghstream::doctor
