#include "pipeline/base/json_names.hpp"

#include <set>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream {

nlohmann::json parse_json(std::string_view text, const std::string& source) {
  using Event = nlohmann::json::parse_event_t;
  check_json_nesting(text, source);
  std::vector<std::set<std::string>> open;  // names in the objects that have begun
  const auto note = [&](int /*depth*/, Event event, const nlohmann::json& parsed) {
    if (event == Event::object_start) open.emplace_back();
    if (event == Event::object_end) open.pop_back();
    if (event == Event::key)
      require(open.back().insert(parsed.get<std::string>()).second, "{}: duplicate '{}' in an object", source,
              printable(parsed.get<std::string>()));
    return true;
  };
  return nlohmann::json::parse(text, note, false);
}

}  // namespace houghstream
