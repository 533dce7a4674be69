#include "tools/doctor/machine.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/tools/doctor/healthy_machine.hpp"

namespace houghstream::doctor {
namespace {

namespace fs = std::filesystem;

TEST(Machine, FilesAreReadBelowItsRootAndMissingOnesAreEmpty) {
  Machine machine;
  machine.root = fresh_folder("machine_read");
  plant(machine.root / "proc/a", "one\ntwo\n");
  EXPECT_EQ(machine.read("proc/a"), "one\ntwo\n");
  EXPECT_EQ(machine.read("proc/b"), "");
  EXPECT_EQ(machine.read("proc"), "");
}

TEST(Machine, ProgramsAreFilesInTheFirstFolderOfThePathThatHasThem) {
  Machine machine;
  machine.root = fresh_folder("machine_path");
  machine.environment = [](const std::string&) { return "relative::/first:/second"; };
  fs::create_directories(machine.root / "first/tool");  // a folder is no program
  plant(machine.root / "second/tool");
  plant(machine.root / "relative/other");
  EXPECT_EQ(machine.find_program("tool"), machine.root / "second/tool");
  EXPECT_EQ(machine.find_program("other"), std::nullopt);
  fs::remove(machine.root / "first/tool");
  plant(machine.root / "first/tool");
  EXPECT_EQ(machine.find_program("tool"), machine.root / "first/tool");
}

TEST(Machine, ThisOneAnswers) {
  const Machine machine = this_machine();
  EXPECT_EQ(machine.root, "/");
  setenv("HOUGHSTREAM_MACHINE_TEST", "7", 1);
  EXPECT_EQ(machine.environment("HOUGHSTREAM_MACHINE_TEST"), "7");
  unsetenv("HOUGHSTREAM_MACHINE_TEST");
  EXPECT_EQ(machine.environment("HOUGHSTREAM_MACHINE_TEST"), "");
  EXPECT_GT(machine.granted_receive_buffer(4096), 0);
  const fs::path file = fresh_folder("machine_mine") / "file";
  EXPECT_FALSE(machine.may_use(file));
  plant(file);
  EXPECT_TRUE(machine.may_use(file));
}

TEST(Machine, ThisOneStartsProgramsAndLoadsLibraries) {
  const Machine machine = this_machine();
  EXPECT_TRUE(machine.runs("/bin/true", "-version"));
  EXPECT_FALSE(machine.runs("/bin/false", "-version"));
  EXPECT_FALSE(machine.runs("/nowhere/java", "-version"));
  EXPECT_NE(machine.load_error("/etc/hostname"), "");
  EXPECT_EQ(machine.load_error("libc.so.6"), "");
}

}  // namespace
}  // namespace houghstream::doctor
