#include "drivers/files/json_file.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/json_names.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream {
namespace {

const nlohmann::json& member(const nlohmann::json& object, const std::string& key, const std::string& where) {
  require(object.is_object() && object.contains(key), "{}: no '{}'", where, key);
  return object.at(key);
}

int index_of(const std::string& key, const std::string& file) {
  int index = -1;
  const char* end = key.data() + key.size();
  const auto result = std::from_chars(key.data(), end, index);
  require(result.ec == std::errc() && result.ptr == end && index >= 0, "{}: key '{}', expected a non-negative integer",
          file, key);
  return index;
}

nlohmann::json read_json(const std::filesystem::path& file) {
  return parse_json(read_file(file, "a JSON file"), file.string());
}

}  // namespace

OrderedJson finite_or_null(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

nlohmann::json read_json_object(const std::filesystem::path& file) {
  nlohmann::json json = read_json(file);
  require(json.is_object(), "{}: not a JSON object, or cut short", file.string());
  return json;
}

nlohmann::json read_json_list(const std::filesystem::path& file) {
  nlohmann::json json = read_json(file);
  require(json.is_array(), "{}: not a JSON list, or cut short", file.string());
  return json;
}

std::map<int, nlohmann::json> read_json_by_id(const std::filesystem::path& file) {
  const nlohmann::json json = read_json_object(file);
  std::map<int, nlohmann::json> entries;
  for (const auto& [key, entry] : json.items()) entries[index_of(key, file.string())] = entry;
  return entries;
}

void write_json(const OrderedJson& json, const std::filesystem::path& file) {
  // A name off the wire may hold any bytes; JSON holds Unicode only (RFC 8259, section 8.1).
  write_file_atomically(file, json.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + '\n');
}

std::string json_text(const nlohmann::json& value) {
  constexpr std::size_t kMaxLength = 200;
  const std::string text = value.dump();
  return text.size() <= kMaxLength ? text : text.substr(0, kMaxLength) + "...";
}

void require_known_names(const nlohmann::json& object, const std::vector<std::string>& known,
                         const std::string& where) {
  for (const auto& [name, value] : object.items()) {
    require(std::find(known.begin(), known.end(), name) != known.end(), "{}: '{}', expected one of {}", where,
            printable(name), fmt::join(known, ", "));
  }
}

double json_number(const nlohmann::json& object, const std::string& key, const std::string& where) {
  const nlohmann::json& value = member(object, key, where);
  if (!value.is_number()) fail("{}: '{}' is {}, expected a number", where, key, json_text(value));
  const auto number = value.get<double>();
  require(std::isfinite(number), "{}: '{}' is {}, expected a finite number", where, key, number);
  return number;
}

int json_integer(const nlohmann::json& object, const std::string& key, const std::string& where) {
  const double number = json_number(object, key, where);
  require(number == std::floor(number) && std::abs(number) < 1e9, "{}: '{}' is {}, expected an integer", where, key,
          number);
  return static_cast<int>(number);
}

std::vector<double> json_numbers(const nlohmann::json& object, const std::string& key, std::size_t count,
                                 const std::string& where) {
  const nlohmann::json& values = member(object, key, where);
  if (!values.is_array() || values.size() != count)
    fail("{}: '{}' is {}, expected {} numbers", where, key, json_text(values), count);
  std::vector<double> numbers;
  for (const nlohmann::json& value : values) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      fail("{}: '{}' holds {}, expected finite numbers", where, key, json_text(value));
    numbers.push_back(value.get<double>());
  }
  return numbers;
}

}  // namespace houghstream
