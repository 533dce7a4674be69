#include "tools/doctor/camera_checks.hpp"

#include <gtest/gtest.h>

#include "tests/tools/doctor/healthy_machine.hpp"

namespace houghstream::doctor {
namespace {

using Level = Finding::Level;

/// Returns the findings of a name, in order.
std::vector<std::string> told(const Findings& findings, const std::string& name) {
  std::vector<std::string> what;
  for (const Finding& finding : findings) {
    if (finding.name == name) what.push_back(finding.what);
  }
  return what;
}

TEST(CameraChecks, EachCameraIsAskedForAtItsPlaceOnTheBus) {
  HealthyMachine healthy("cameras_two");
  healthy.plant_camera("2-1", "8086", "0b07", 17);
  healthy.plant_camera("2-2", "046d", "0825", 18);  // no RGB-D camera
  std::vector<std::string> asked;
  healthy.machine.may_use = [&](const std::filesystem::path& file) {
    asked.push_back(file.lexically_relative(healthy.machine.root).string());
    return true;
  };
  const Findings findings = check_camera(healthy.machine, true);
  EXPECT_EQ(asked, (std::vector<std::string>{"dev/bus/usb/001/002", "dev/bus/usb/001/017"}));
  const std::vector<std::string> rights = {"PrimeSense or Xtion (1d27:0601) may be used",
                                           "RealSense D435 (8086:0b07) may be used"};
  EXPECT_EQ(told(findings, "camera rights"), rights);
  EXPECT_EQ(told(findings, "camera driver").size(), 2U);
  EXPECT_EQ(told(findings, "camera driver")[0], "libPS1080.so.0 for the PrimeSense or Xtion");
}

TEST(CameraChecks, APortIsTooSlowBelowHighSpeedAndFineWhereItDoesNotTell) {
  const HealthyMachine healthy("cameras_speed");
  const auto level_at = [&](const std::string& speed) {
    plant(healthy.machine.root / "sys/bus/usb/devices/1-1/speed", speed);
    return check_camera(healthy.machine, true).front().level;
  };
  EXPECT_EQ(level_at("12\n"), Level::kWrong);
  EXPECT_EQ(level_at("480\n"), Level::kOk);
  EXPECT_EQ(level_at("5000\n"), Level::kOk);
  EXPECT_EQ(level_at(""), Level::kOk);
}

TEST(CameraChecks, WhatIsMissingIsANoteWhereNoCameraIsThereOrNeeded) {
  const HealthyMachine healthy("cameras_none");
  std::filesystem::remove_all(healthy.machine.root / "sys/bus/usb");
  std::filesystem::remove_all(healthy.drivers());
  for (const bool needed : {false, true}) {
    const Findings findings = check_camera(healthy.machine, needed);
    ASSERT_EQ(findings.size(), 3U);  // camera, OpenNI2, driver folder
    EXPECT_EQ(findings[0].level, needed ? Level::kWrong : Level::kNote);
    EXPECT_EQ(findings[1].level, Level::kOk);
    EXPECT_EQ(findings[2].level, needed ? Level::kWrong : Level::kNote);
  }
}

}  // namespace
}  // namespace houghstream::doctor
