#pragma once

#include <filesystem>
#include <string>

#include "tests/test_files.hpp"
#include "tools/doctor/examination.hpp"

namespace houghstream::doctor {

/// Writes a file and makes all folders above it.
inline void plant(const std::filesystem::path& file, const std::string& text = "") {
  std::filesystem::create_directories(file.parent_path());
  write_text(file, text);
}

/// A machine on which everything is there, an Xtion plugged in: files in a folder of the test's own, and probes that
/// answer well.
struct HealthyMachine {
  explicit HealthyMachine(const std::string& test) {
    const std::filesystem::path root = fresh_folder(test);
    machine.root = root;
    plant(root / "proc/net/route",
          "Iface\tDestination\tGateway\tFlags\tRefCnt\tUse\tMetric\tMask\tMTU\tWindow\tIRTT\n"
          "eth0\t000200C0\t00000000\t0001\t0\t0\t0\t00FFFFFF\t0\t0\t0\n"
          "lo\t000000E0\t00000000\t0001\t0\t0\t0\t000000F0\t0\t0\t0\n");
    plant(root / "proc/sys/net/core/rmem_default", "4194304\n");
    plant(root / "proc/cpuinfo", "processor\t: 0\nflags\t\t: fpu sse4_2 avx avx2\nprocessor\t: 1\n");
    plant(openni_library());
    for (const char* name : {"libPS1080", "libOniFile"}) {
      plant(drivers() / (name + std::string(".so")));
      plant(drivers() / (name + std::string(".so.0")));
    }
    plant_camera("1-1", "1d27", "0601", 2);
    for (const char* name : {"java", "lcm-logger", "lcm-logplayer"}) plant(root / "usr/bin" / name);
    for (const char* name : {"lcm.jar", "jchart2d.jar"}) plant(root / "usr/share/java" / name);
    settings.types_jar = root / "build/bin/houghstream_types.jar";
    plant(settings.types_jar);
    settings.programs = root / "build/bin";
    for (const char* module : {"houghstream/event_log.py", "numpy/__init__.py", "PIL/__init__.py", "lcm/__init__.py"})
      plant(root / "usr/lib/python3/dist-packages" / module);
    machine.environment = [](const std::string& name) -> std::string {
      return name == "PATH" ? "/usr/local/bin:/usr/bin" : name == "DISPLAY" ? ":0" : "";
    };
    machine.granted_receive_buffer = [](std::int64_t asked) { return asked; };
    machine.heard_bytes = [](const std::string&, const std::string&) { return std::size_t{0}; };
    machine.heard_frame_channels = [](const std::string&) { return std::set<std::string>(); };
    machine.heard_camera_timings = [](const std::string&) { return std::vector<CameraTiming>(); };
    machine.heard_camera_colours = [](const std::string&) { return std::vector<CameraChroma>(); };
    machine.heard_errors = [](const std::string&) { return std::map<std::string, std::string>(); };
    machine.self_test = [](const std::string&, std::size_t) { return SelfTest{5, 5, ""}; };
    machine.may_use = [](const std::filesystem::path&) { return true; };
    machine.load_error = [](const std::filesystem::path&) { return std::string(); };
    machine.refuses_others = [](const std::string&) { return true; };
    machine.runs = [](const std::filesystem::path&, const std::string&) { return true; };
  }

  std::filesystem::path openni_library() const { return machine.root / "usr/lib/x86_64-linux-gnu/libOpenNI2.so.0"; }
  std::filesystem::path drivers() const { return openni_library().parent_path() / "OpenNI2/Drivers"; }

  void plant_camera(const std::string& port, const std::string& vendor, const std::string& product, int number) {
    const std::filesystem::path device = machine.root / "sys/bus/usb/devices" / port;
    plant(device / "idVendor", vendor + "\n");
    plant(device / "idProduct", product + "\n");
    plant(device / "busnum", "1\n");
    plant(device / "devnum", std::to_string(number) + "\n");
    plant(device / "speed", "480\n");
  }

  Machine machine;
  ExaminationSettings settings;
};

}  // namespace houghstream::doctor
