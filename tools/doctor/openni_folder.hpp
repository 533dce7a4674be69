#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/doctor/machine.hpp"

namespace houghstream::doctor {

/// The OpenNI2 library that a program would load, libOpenNI2.so.0: on $LD_LIBRARY_PATH, then in the system's folders.
std::optional<std::filesystem::path> find_openni(const Machine& machine);

/// Returns where that library looks for drivers: Repository= in etc/openni2/OpenNI.ini, else OpenNI2/Drivers beside it.
std::filesystem::path driver_folder(const Machine& machine, const std::filesystem::path& library);

/// The drivers in it, in the order of their names. Debian's library loads lib*.so.0 and nothing else.
struct Drivers {
  std::vector<std::filesystem::path> named_right;  ///< lib*.so.0
  std::vector<std::filesystem::path> named_wrong;  ///< lib*.so* without a lib*.so.0
};
Drivers list_drivers(const std::filesystem::path& folder);

/// Returns a path as users know it: without the root that was examined.
std::string shown(const Machine& machine, const std::filesystem::path& path);

}  // namespace houghstream::doctor
