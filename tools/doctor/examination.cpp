#include "tools/doctor/examination.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/doctor/camera_checks.hpp"
#include "tools/doctor/installation_checks.hpp"
#include "tools/doctor/network_checks.hpp"

namespace houghstream::doctor {
namespace {

const char* to_string(Finding::Level level) {
  switch (level) {
    case Finding::Level::kOk: return "ok";
    case Finding::Level::kNote: return "note";
    case Finding::Level::kWrong: break;
  }
  return "WRONG";
}

/// The URL that LcmBus takes.
std::string url_in_use(const Machine& machine, const std::string& given) {
  if (!given.empty()) return given;
  const std::string environment = machine.environment("LCM_DEFAULT_URL");
  return environment.empty() ? "udpm://239.255.76.67:7667?ttl=0" : environment;
}

}  // namespace

Findings examine(const Machine& machine, const ExaminationSettings& settings) {
  constexpr std::size_t kBytesPerPixel = 5;  // three of colour, two of depth
  const auto raw_frame =
      static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height) * kBytesPerPixel;
  Findings all = check_network(machine, {url_in_use(machine, settings.lcm_url), settings.frame_channel, raw_frame});
  for (const Findings& part : {check_camera(machine, settings.live), check_tools(machine, settings.types_jar),
                               check_installation(machine, settings.programs)}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

std::string to_text(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text += fmt::format("{:<5}  {:<15}  {}\n", to_string(finding.level), finding.name, finding.what);
    if (!finding.remedy.empty()) text += fmt::format("       mend it with:    {}\n", finding.remedy);
  }
  return text;
}

int count_wrong(const Findings& findings) {
  return static_cast<int>(std::count_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.level == Finding::Level::kWrong;
  }));
}

}  // namespace houghstream::doctor
