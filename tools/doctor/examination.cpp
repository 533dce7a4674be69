#include "tools/doctor/examination.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/base/printable.hpp"
#include "pipeline/base/terminal_colour.hpp"
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

TerminalColour colour_of(Finding::Level level) {
  switch (level) {
    case Finding::Level::kOk: return TerminalColour::kGreen;
    case Finding::Level::kNote: return TerminalColour::kYellow;
    case Finding::Level::kWrong: break;
  }
  return TerminalColour::kRed;
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

std::string to_text(const Findings& findings, bool in_colours) {
  std::string text;
  for (const Finding& finding : findings) {
    const std::string level = fmt::format("{:<5}", to_string(finding.level));
    text += fmt::format("{}  {:<15}  {}\n", in_colour(level, colour_of(finding.level), in_colours), finding.name,
                        finding.what);
    if (!finding.remedy.empty()) text += fmt::format("       mend it with:    {}\n", finding.remedy);
  }
  return text;
}

OrderedJson to_json(const Findings& findings) {
  OrderedJson entries = OrderedJson::array();
  for (const Finding& finding : findings) {
    OrderedJson entry;
    entry["level"] = finding.level == Finding::Level::kWrong ? "wrong" : to_string(finding.level);
    entry["name"] = finding.name;
    entry["found"] = printable(finding.what);
    entry["remedy"] = finding.remedy.empty() ? OrderedJson() : OrderedJson(finding.remedy);
    entries.push_back(std::move(entry));
  }
  OrderedJson json;
  json["works"] = count_wrong(findings) == 0;
  json["findings"] = std::move(entries);
  return json;
}

int count_wrong(const Findings& findings) {
  return static_cast<int>(std::count_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.level == Finding::Level::kWrong;
  }));
}

}  // namespace houghstream::doctor
