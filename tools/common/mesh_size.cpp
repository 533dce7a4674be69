#include "tools/common/mesh_size.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace houghstream {
namespace {

constexpr double kMin_m = 0.01;
constexpr double kMax_m = 1.5;  // size that the camera's range of 0.3 to 2.6 m shows whole

struct Unit {
  const char* name;
  double metres;
};
constexpr Unit kUnits[] = {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}};

std::string unit_name(double unit_m) {
  for (const Unit& unit : kUnits) {
    if (std::abs(unit.metres - unit_m) < 1e-9) return unit.name;
  }
  return fmt::format("units of {} m", unit_m);
}

}  // namespace

std::string mesh_size_error(double size_m, double unit_m, const std::string& unit) {
  if (size_m >= kMin_m && size_m <= kMax_m) return "";
  std::vector<std::string> fitting;
  for (const Unit& other : kUnits) {
    const double so_m = size_m / unit_m * other.metres;
    if (so_m >= kMin_m && so_m <= kMax_m)
      fitting.push_back(fmt::format("{} {} would make it {:.3g} m", unit, other.name, so_m));
  }
  return fmt::format("{:.4g} m across when read in {}, expected {} to {} m, what the camera sees{}{}", size_m,
                     unit_name(unit_m), kMin_m, kMax_m, fitting.empty() ? "" : ": ", fmt::join(fitting, ", "));
}

std::string fault_of_sizes(const std::map<std::string, Mesh>& models, double unit_m, const std::string& unit) {
  std::string line;
  int count = 0;
  for (const auto& [name, mesh] : models) {
    const double size_m = mesh_bounds(mesh).diagonal().norm();
    const std::string fault = mesh_size_error(size_m, unit_m, unit);
    if (fault.empty()) continue;
    if (line.empty()) line = fmt::format("model '{}': {}", name, fault);
    ++count;
  }
  return count > 1 ? fmt::format("{}; so it is with {} of {} models", line, count, models.size()) : line;
}

}  // namespace houghstream
