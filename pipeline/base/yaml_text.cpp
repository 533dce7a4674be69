#include "pipeline/base/yaml_text.hpp"

#include <set>
#include <sstream>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream {
namespace {

/// Returns the text without lines that would begin other documents, or unknown directives.
std::string one_document(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("---", 0) == 0 || line.rfind("%YAML", 0) == 0) continue;
    out += line + "\n";
  }
  return out;
}

}  // namespace

YAML::Node parse_yaml(const std::string& text, const std::string& source) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;
  require(text.size() <= kMaxBytes, "{}: {} bytes of YAML, expected at most {}", source, text.size(), kMaxBytes);
  YAML::Node map;
  try {
    map = YAML::Load(one_document(text));
  } catch (const YAML::Exception& error) {
    fail("{}: no YAML: {}", source, printable(error.what()));
  }
  require(map.IsMap(), "{}: no YAML of names and values", source);
  yaml_names(map, source);
  return map;
}

std::vector<std::string> yaml_names(const YAML::Node& map, const std::string& of) {
  std::vector<std::string> names;
  for (const auto& entry : map) {
    require(entry.first.IsScalar(), "{}: a name that is no text, expected names and values", of);
    names.push_back(entry.first.Scalar());
  }
  std::set<std::string> seen;
  for (const std::string& name : names) require(seen.insert(name).second, "{}: duplicate '{}'", of, printable(name));
  return names;
}

YAML::Node yaml_member(const YAML::Node& map, const std::string& name) {
  if (!map.IsDefined() || !map.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
  return map[name];
}

std::optional<double> yaml_number(const YAML::Node& node) {
  double number = 0.0;
  if (!node.IsDefined() || !node.IsScalar() || !YAML::convert<double>::decode(node, number)) return std::nullopt;
  return number;
}

}  // namespace houghstream
