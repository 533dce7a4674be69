#include "tools/doctor/camera_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "tools/doctor/openni_folder.hpp"

namespace houghstream::doctor {
namespace {

namespace fs = std::filesystem;

/// Properties of a kind of RGB-D camera.
struct CameraKind {
  const char* vendor;        ///< USB id
  const char* product;       ///< USB id; "" = all of the vendor's
  const char* name;          ///< name for people
  const char* driver;        ///< its OpenNI2 driver's file begins with this
  const char* installation;  ///< command; {} is the folder of drivers
};

constexpr CameraKind kKinds[] = {
    {"1d27", "", "PrimeSense or Xtion", "libPS1080", "sudo apt-get install --reinstall libopenni2-0"},
    {"045e", "02ae", "Kinect", "libFreenectDriver",
     "git clone https://github.com/OpenKinect/libfreenect && cmake -S libfreenect -B libfreenect/build "
     "-DBUILD_OPENNI2_DRIVER=ON && cmake --build libfreenect/build && "
     "sudo cp -L libfreenect/build/lib/OpenNI2-FreenectDriver/libFreenectDriver.so {}/libFreenectDriver.so.0"},
    {"045e", "02c4", "Kinect v2", "libfreenect2", "sudo cp -L libfreenect2-openni2.so {}/libfreenect2-openni2.so.0"},
    {"045e", "02d8", "Kinect v2", "libfreenect2", "sudo cp -L libfreenect2-openni2.so {}/libfreenect2-openni2.so.0"},
    {"2bc5", "", "Orbbec", "liborbbec", "sudo cp -L liborbbec.so {}/liborbbec.so.0"},
    {"8086", "0b07", "RealSense D435", "librs2driver", "sudo cp -L librs2driver.so {}/librs2driver.so.0"},
    {"8086", "0b3a", "RealSense D435i", "librs2driver", "sudo cp -L librs2driver.so {}/librs2driver.so.0"},
    {"8086", "0ad3", "RealSense D415", "librs2driver", "sudo cp -L librs2driver.so {}/librs2driver.so.0"},
};

/// A camera that is plugged in.
struct UsbCamera {
  CameraKind kind;
  std::string id;    ///< vendor:product
  fs::path device;   ///< its file in dev/bus/usb
  double speed = 0;  ///< megabits per second; 0 = unknown
};

std::string word(const Machine& machine, const fs::path& file) {
  const std::string text = machine.read(file.lexically_relative(machine.root).string());
  return text.substr(0, text.find_first_of(" \n"));
}

std::vector<UsbCamera> plugged_cameras(const Machine& machine) {
  std::vector<UsbCamera> cameras;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(machine.root / "sys/bus/usb/devices", error)) {
    const std::string vendor = word(machine, entry.path() / "idVendor");
    const std::string product = word(machine, entry.path() / "idProduct");
    const auto known = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const CameraKind& kind) {
      return vendor == kind.vendor && (kind.product[0] == 0 || product == kind.product);
    });
    if (known == std::end(kKinds)) continue;
    const int bus = std::atoi(word(machine, entry.path() / "busnum").c_str());
    const int number = std::atoi(word(machine, entry.path() / "devnum").c_str());
    cameras.push_back({*known, fmt::format("{}:{}", vendor, product),
                       machine.root / fmt::format("dev/bus/usb/{:03d}/{:03d}", bus, number),
                       std::atof(word(machine, entry.path() / "speed").c_str())});
  }
  std::sort(cameras.begin(), cameras.end(), [](const auto& a, const auto& b) { return a.device < b.device; });
  return cameras;
}

/// The command that lists what is plugged in of all that is known.
std::string listing_of_cameras() {
  std::string vendors;
  for (const CameraKind& kind : kKinds) {
    const std::string vendor = kind.vendor;
    if (vendors.find(vendor) == std::string::npos) vendors += (vendors.empty() ? "" : "|") + vendor;
  }
  return fmt::format("lsusb | grep -E 'ID ({})'", vendors);
}

Finding check_rights(const Machine& machine, const UsbCamera& camera) {
  const std::string name = fmt::format("{} ({})", camera.kind.name, camera.id);
  if (!machine.may_use(camera.device)) {
    const std::string vendor = camera.kind.vendor;
    return wrong("camera rights",
                 fmt::format("{}: {} may not be used by this user", name, shown(machine, camera.device)),
                 fmt::format("echo 'SUBSYSTEM==\"usb\", ATTR{{idVendor}}==\"{0}\", MODE=\"0666\"' | sudo tee "
                             "/etc/udev/rules.d/60-houghstream-{0}.rules && sudo udevadm control --reload && sudo "
                             "udevadm trigger",
                             vendor));
  }
  constexpr double kHighSpeed = 480;
  if (camera.speed > 0 && camera.speed < kHighSpeed) {
    return wrong("camera rights", fmt::format("{}: runs at {} Mbit/s, too slow for images; use another port or cable",
                                              name, camera.speed));
  }
  return ok("camera rights", fmt::format("{} may be used", name));
}

Findings check_drivers(const Machine& machine, const fs::path& folder, Finding::Level missing) {
  Findings findings;
  const Drivers drivers = list_drivers(folder);
  for (const fs::path& file : drivers.named_wrong) {
    const std::string name = file.filename().string();
    const std::string right = name.substr(0, name.find(".so")) + ".so.0";
    findings.push_back({missing, "driver name", fmt::format("{} is passed over, OpenNI2 loads lib*.so.0 only", name),
                        fmt::format("sudo ln -s {} {}/{}", name, shown(machine, folder), right)});
  }
  for (const fs::path& file : drivers.named_right) {
    const std::string error = machine.load_error(file);
    if (error.empty()) continue;
    findings.push_back(
        {missing, "driver loading", error, fmt::format("ldd {} | grep 'not found'", shown(machine, file))});
  }
  if (drivers.named_right.empty()) {
    const bool usual = folder.lexically_relative(machine.root).string().rfind("usr/", 0) == 0;
    findings.push_back({missing, "driver folder", fmt::format("{}: no lib*.so.0 in it", shown(machine, folder)),
                        usual ? "sudo apt-get install --reinstall libopenni2-0"
                              : "sudo sed -i 's/^Repository=/;Repository=/' /etc/openni2/OpenNI.ini"});
  } else if (findings.empty()) {
    findings.push_back(
        ok("driver folder", fmt::format("{}: {} drivers", shown(machine, folder), drivers.named_right.size())));
  }
  return findings;
}

Finding check_driver_of(const Machine& machine, const UsbCamera& camera, const fs::path& folder) {
  for (const fs::path& file : list_drivers(folder).named_right) {
    const std::string name = file.filename().string();
    if (name.rfind(camera.kind.driver, 0) == 0) {
      return ok("camera driver", fmt::format("{} for the {}", name, camera.kind.name));
    }
  }
  return wrong(
      "camera driver",
      fmt::format("no {}*.so.0 for the {} in {}", camera.kind.driver, camera.kind.name, shown(machine, folder)),
      fmt::format(fmt::runtime(camera.kind.installation), shown(machine, folder)));
}

}  // namespace

Findings check_camera(const Machine& machine, bool needed) {
  const std::vector<UsbCamera> cameras = plugged_cameras(machine);
  const Finding::Level missing = needed || !cameras.empty() ? Finding::Level::kWrong : Finding::Level::kNote;
  Findings findings;
  if (cameras.empty()) {
    findings.push_back({missing, "camera", "no RGB-D camera that is known here is plugged in",
                        needed ? "plug one in, and see whether it is there: " + listing_of_cameras() : ""});
  }
  for (const UsbCamera& camera : cameras) findings.push_back(check_rights(machine, camera));
  const std::optional<fs::path> library = find_openni(machine);
  if (!library) {
    findings.push_back({missing, "OpenNI2", "libOpenNI2.so.0 not found", "sudo apt-get install libopenni2-0"});
    return findings;
  }
  findings.push_back(ok("OpenNI2", shown(machine, *library)));
  const fs::path folder = driver_folder(machine, *library);
  for (Finding& finding : check_drivers(machine, folder, missing)) findings.push_back(std::move(finding));
  if (!list_drivers(folder).named_right.empty()) {
    for (const UsbCamera& camera : cameras) findings.push_back(check_driver_of(machine, camera, folder));
  }
  // The kernel's own driver for the Kinect's images holds the device.
  const bool kinect =
      std::any_of(cameras.begin(), cameras.end(), [](const UsbCamera& camera) { return camera.id == "045e:02ae"; });
  if (kinect && fs::exists(machine.root / "sys/module/gspca_kinect")) {
    findings.push_back(wrong("kernel module", "gspca_kinect holds the Kinect",
                             "sudo modprobe -r gspca_kinect; echo blacklist gspca_kinect | sudo tee "
                             "/etc/modprobe.d/houghstream-kinect.conf"));
  }
  return findings;
}

}  // namespace houghstream::doctor
