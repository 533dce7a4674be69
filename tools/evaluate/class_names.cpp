#include "tools/evaluate/class_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

/// Lists enough names to show which they are: a dataset may hold hundreds.
std::string listed(const std::set<std::string>& names) {
  constexpr std::size_t kShown = 20;
  const std::vector<std::string> shown(names.begin(), std::next(names.begin(), std::min(kShown, names.size())));
  const std::string more = names.size() > kShown ? fmt::format(" and {} more", names.size() - kShown) : "";
  return names.empty() ? "nothing" : fmt::format("{}{}", fmt::join(shown, ", "), more);
}

}  // namespace

void require_shared_name(const NamedSide& a, const NamedSide& b) {
  const bool shared =
      std::any_of(a.names.begin(), a.names.end(), [&](const std::string& name) { return b.names.count(name) > 0; });
  require(shared, "no name in common: {} has {}; {} has {}", a.what, listed(a.names), b.what, listed(b.names));
}

std::set<std::string> ground_truth_names(const std::vector<EvaluatedFrame>& frames) {
  std::set<std::string> names;
  for (const EvaluatedFrame& frame : frames) {
    for (const NamedObject& object : frame.objects) names.insert(object.class_name);
  }
  return names;
}

std::set<std::string> detected_names(const std::vector<Detections>& results) {
  std::set<std::string> names;
  for (const Detections& result : results) {
    for (const Detection& detection : result.detections) names.insert(detection.class_name);
  }
  return names;
}

}  // namespace houghstream
