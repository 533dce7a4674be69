#include "tools/doctor/examination.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/tools/doctor/healthy_machine.hpp"

namespace houghstream::doctor {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

/// Something that is wrong with a machine, and how it has to be reported.
struct Fault {
  const char* what;
  std::function<void(HealthyMachine&)> plant;
  Level level;
  const char* name;    ///< name of the finding
  const char* remedy;  ///< a part of the command
};

const std::vector<Fault> kFaults = {
    {"small receive buffers",
     [](HealthyMachine& m) { m.machine.granted_receive_buffer = [](std::int64_t) { return 212992; }; }, Level::kWrong,
     "receive buffer", "sudo sysctl -w net.core.rmem_max=16777216"},
    {"a small default buffer",
     [](HealthyMachine& m) { plant(m.machine.root / "proc/sys/net/core/rmem_default", "212992"); }, Level::kNote,
     "Java's buffer", "net.core.rmem_default=4194304"},
    {"no route", [](HealthyMachine& m) { plant(m.machine.root / "proc/net/route", "Iface\tDestination\n"); },
     Level::kWrong, "multicast route", "sudo ip route add 224.0.0.0/4 dev lo"},
    {"a route that rejects",
     [](HealthyMachine& m) {
       replace_in_file(m.machine.root / "proc/net/route", "000000E0\t00000000\t0001", "000000E0\t00000000\t0201");
     },
     Level::kWrong, "multicast route", "sudo ip route add"},
    {"a firewall",
     [](HealthyMachine& m) {
       m.machine.self_test = [](const std::string&, std::size_t) { return SelfTest{5, 0, ""}; };
     },
     Level::kWrong, "LCM self test", "sudo iptables -I INPUT -p udp -d 239.255.76.67 --dport 7667 -j ACCEPT"},
    {"a bus that loses",
     [](HealthyMachine& m) {
       m.machine.self_test = [](const std::string&, std::size_t) { return SelfTest{5, 3, ""}; };
     },
     Level::kWrong, "LCM self test", "sudo sysctl"},
    {"a bus that cannot be opened",
     [](HealthyMachine& m) {
       m.machine.self_test = [](const std::string&, std::size_t) { return SelfTest{0, 0, "no bus"}; };
     },
     Level::kWrong, "LCM self test", "sudo ip link set lo multicast on"},
    {"no OpenNI2", [](HealthyMachine& m) { fs::remove(m.openni_library()); }, Level::kWrong, "OpenNI2",
     "sudo apt-get install libopenni2-0"},
    {"no driver folder", [](HealthyMachine& m) { fs::remove_all(m.drivers()); }, Level::kWrong, "driver folder",
     "sudo apt-get install --reinstall libopenni2-0"},
    {"another driver folder configured",
     [](HealthyMachine& m) {
       plant(m.machine.root / "etc/openni2/OpenNI.ini", "[Drivers]\nRepository=/opt/drivers\n");
     },
     Level::kWrong, "driver folder", "sudo sed"},
    {"a wrong name", [](HealthyMachine& m) { plant(m.drivers() / "libFreenectDriver.so"); }, Level::kWrong,
     "driver name", "sudo ln -s libFreenectDriver.so /usr/lib/x86_64-linux-gnu/OpenNI2/Drivers/libFreenectDriver.so.0"},
    {"a driver that cannot be loaded",
     [](HealthyMachine& m) {
       m.machine.load_error = [](const fs::path& file) {
         return file.filename() == "libPS1080.so.0" ? "libudev.so.0: cannot open" : "";
       };
     },
     Level::kWrong, "driver loading", "ldd /usr/lib/x86_64-linux-gnu/OpenNI2/Drivers/libPS1080.so.0"},
    {"a camera without a driver", [](HealthyMachine& m) { m.plant_camera("1-2", "045e", "02ae", 3); }, Level::kWrong,
     "camera driver", "-DBUILD_OPENNI2_DRIVER=ON"},
    {"no rights",
     [](HealthyMachine& m) { m.machine.may_use = [](const fs::path& file) { return file.filename() != "002"; }; },
     Level::kWrong, "camera rights", "ATTR{idVendor}==\"1d27\", MODE=\"0666\"' | sudo tee /etc/udev/rules.d/"},
    {"a slow port", [](HealthyMachine& m) { plant(m.machine.root / "sys/bus/usb/devices/1-1/speed", "12\n"); },
     Level::kWrong, "camera rights", ""},
    {"the kernel's Kinect driver",
     [](HealthyMachine& m) {
       m.plant_camera("1-2", "045e", "02ae", 3);
       plant(m.drivers() / "libFreenectDriver.so.0");
       plant(m.machine.root / "sys/module/gspca_kinect/refcnt", "0");
     },
     Level::kWrong, "kernel module", "sudo modprobe -r gspca_kinect"},
    {"no camera where one is needed",
     [](HealthyMachine& m) {
       fs::remove_all(m.machine.root / "sys/bus/usb/devices/1-1");
       m.settings.live = true;
     },
     Level::kWrong, "camera", "lsusb | grep -E 'ID (1d27|045e|2bc5|8086)'"},
    {"a URL that is none", [](HealthyMachine& m) { m.settings.lcm_url = "bogus"; }, Level::kWrong, "the bus",
     "export LCM_DEFAULT_URL="},
    {"a log in place of a bus", [](HealthyMachine& m) { m.settings.lcm_url = "file:///x"; }, Level::kWrong, "the bus",
     "export LCM_DEFAULT_URL="},
    {"an option that LCM does not know", [](HealthyMachine& m) { m.settings.lcm_url = "udpm://?tll=1"; }, Level::kNote,
     "the bus", ""},
    {"one processor",
     [](HealthyMachine& m) { plant(m.machine.root / "proc/cpuinfo", "processor : 0\nflags : avx2\n"); }, Level::kNote,
     "processor", ""},
    {"no AVX2", [](HealthyMachine& m) { replace_in_file(m.machine.root / "proc/cpuinfo", " avx2", ""); }, Level::kNote,
     "processor", ""},
    {"no lcm-logger", [](HealthyMachine& m) { fs::remove(m.machine.root / "usr/bin/lcm-logger"); }, Level::kNote,
     "LCM's tools", "sudo apt-get install liblcm-bin"},
    {"no Java", [](HealthyMachine& m) { fs::remove(m.machine.root / "usr/bin/java"); }, Level::kNote, "Java",
     "sudo apt-get install default-jre"},
    {"Java that does not run",
     [](HealthyMachine& m) { m.machine.runs = [](const fs::path&, const std::string&) { return false; }; },
     Level::kNote, "Java", "sudo apt-get install --reinstall default-jre"},
    {"no lcm.jar", [](HealthyMachine& m) { fs::remove(m.machine.root / "usr/share/java/lcm.jar"); }, Level::kNote,
     "lcm-spy", "sudo apt-get install liblcm-java"},
    {"no types for Java", [](HealthyMachine& m) { fs::remove(m.settings.types_jar); }, Level::kNote, "lcm-spy",
     "default-jdk-headless"},
    {"an old installation", [](HealthyMachine& m) { plant(m.machine.root / "usr/bin/hs-detect"); }, Level::kNote,
     "programs", "sudo apt-get remove houghstream"},
    {"no Python package",
     [](HealthyMachine& m) { fs::remove_all(m.machine.root / "usr/lib/python3/dist-packages/houghstream"); },
     Level::kNote, "Python", "python3-houghstream"},
    {"no numpy", [](HealthyMachine& m) { fs::remove_all(m.machine.root / "usr/lib/python3/dist-packages/numpy"); },
     Level::kNote, "Python", "sudo apt-get install python3-numpy"},
    {"no display",
     [](HealthyMachine& m) {
       m.machine.environment = [](const std::string& name) { return name == "PATH" ? "/usr/bin" : ""; };
     },
     Level::kNote, "display", "--snapshot"},
};

const Finding* find(const Findings& findings, const Fault& fault) {
  for (const Finding& finding : findings) {
    if (finding.name == fault.name && finding.level == fault.level) return &finding;
  }
  return nullptr;
}

TEST(Examination, PassesAHealthyMachine) {
  const HealthyMachine healthy("doctor_healthy");
  const Findings findings = examine(healthy.machine, healthy.settings);
  for (const Finding& finding : findings) EXPECT_EQ(finding.level, Level::kOk) << finding.name << ": " << finding.what;
  EXPECT_GE(findings.size(), 12U);
  EXPECT_EQ(count_wrong(findings), 0);
}

TEST(Examination, FindsEachPlantedFaultAndNamesItsRemedy) {
  for (const Fault& fault : kFaults) {
    HealthyMachine ill("doctor_ill");
    fault.plant(ill);
    const Findings findings = examine(ill.machine, ill.settings);
    const Finding* finding = find(findings, fault);
    ASSERT_NE(finding, nullptr) << fault.what << "\n" << to_text(findings);
    EXPECT_NE(finding->remedy.find(fault.remedy), std::string::npos) << fault.what << ": " << finding->remedy;
    EXPECT_EQ(count_wrong(findings), fault.level == Level::kWrong ? 1 : 0) << fault.what << "\n" << to_text(findings);
  }
}

TEST(Examination, WithoutACameraRecordingsStillWork) {
  HealthyMachine machine("doctor_no_camera");
  fs::remove_all(machine.machine.root / "sys/bus/usb/devices/1-1");
  fs::remove(machine.openni_library());
  const Findings findings = examine(machine.machine, machine.settings);
  EXPECT_EQ(count_wrong(findings), 0) << to_text(findings);
  EXPECT_NE(to_text(findings).find("note   camera"), std::string::npos) << to_text(findings);
  machine.settings.live = true;
  EXPECT_EQ(count_wrong(examine(machine.machine, machine.settings)), 2);
}

TEST(Examination, JsonAndColoursSayTheSameAsTheText) {
  const Findings findings = {ok("route", "there"), note("camera", "none"), wrong("bus", "deaf", "sudo hear")};
  const OrderedJson json = to_json(findings);
  EXPECT_FALSE(json["works"]);
  ASSERT_EQ(json["findings"].size(), 3U);
  EXPECT_EQ(json["findings"][0]["level"], "ok");
  EXPECT_TRUE(json["findings"][0]["remedy"].is_null());
  EXPECT_EQ(json["findings"][2]["level"], "wrong");
  EXPECT_EQ(json["findings"][2]["found"], "deaf");
  EXPECT_EQ(json["findings"][2]["remedy"], "sudo hear");
  EXPECT_TRUE(to_json({ok("route", "there")})["works"]);

  EXPECT_EQ(to_text(findings).find('\x1b'), std::string::npos);
  std::string coloured = to_text(findings, true);
  for (const char* part : {"\x1b[32mok   \x1b[0m  route", "\x1b[33mnote \x1b[0m  camera", "\x1b[31mWRONG\x1b[0m  bus"})
    EXPECT_NE(coloured.find(part), std::string::npos) << part << " in\n" << coloured;
}

TEST(Examination, BuffersAreComparedWithTheFramesInUse) {
  HealthyMachine machine("doctor_frames");
  machine.machine.granted_receive_buffer = [](std::int64_t) { return 500'000; };
  EXPECT_EQ(count_wrong(examine(machine.machine, machine.settings)), 1) << "raw VGA frames are assumed";
  machine.machine.heard_bytes = [](const std::string&, const std::string& channel) {
    return channel == "OPENNI_FRAME" ? std::size_t{150'000} : 0;
  };
  EXPECT_EQ(count_wrong(examine(machine.machine, machine.settings)), 0) << "smaller frames are heard";
  machine.machine.heard_bytes = [](const std::string&, const std::string&) { return std::size_t{10'000'000}; };
  const std::string text = to_text(examine(machine.machine, machine.settings));
  EXPECT_NE(text.find("rmem_max=27306667"), std::string::npos) << "larger frames need more than usual: " << text;
}

TEST(Examination, ABusWithoutDatagramsNeedsNoRouteAndNoBuffers) {
  HealthyMachine machine("doctor_tcp");
  machine.settings.lcm_url = "tcpq://robot";
  machine.machine.granted_receive_buffer = [](std::int64_t) { return 0; };
  plant(machine.machine.root / "proc/net/route", "");
  EXPECT_EQ(count_wrong(examine(machine.machine, machine.settings)), 0);
  machine.machine.self_test = [](const std::string&, std::size_t) { return SelfTest{0, 0, "no server"}; };
  const Findings findings = examine(machine.machine, machine.settings);
  EXPECT_EQ(count_wrong(findings), 1);
  EXPECT_NE(to_text(findings).find("on robot: java -cp /usr/share/java/lcm.jar lcm.lcm.TCPService 7700\n"),
            std::string::npos)
      << to_text(findings);
}

}  // namespace
}  // namespace houghstream::doctor
