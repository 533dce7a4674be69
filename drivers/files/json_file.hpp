#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace houghstream {

/// Keys keep the order in which they are written, so that image 10 follows image 9.
using OrderedJson = nlohmann::ordered_json;

/// Returns null for NaN and infinity, which JSON lacks: null means unknown.
OrderedJson finite_or_null(double value);

// Files whose lists are nested more than 64 times are refused (pipeline/base/files.hpp), and those with a duplicate
// name in an object.

/// Throws InputError when the file is missing or no JSON object.
nlohmann::json read_json_object(const std::filesystem::path& file);

/// Throws InputError when the file is missing or no JSON list.
nlohmann::json read_json_list(const std::filesystem::path& file);

/// Reads the entries of an object whose keys are numbers, by number: as text, "10" comes before "9". Throws InputError
/// as above, and where a key is no non-negative integer.
std::map<int, nlohmann::json> read_json_by_id(const std::filesystem::path& file);

/// Throws InputError when the file cannot be written.
void write_json(const OrderedJson& json, const std::filesystem::path& file);

/// Returns the value for a message; a long one is cut.
std::string json_text(const nlohmann::json& value);

// The functions below throw InputError naming `where` (file and entry): those that give a value when the key is missing
// or of another type.

/// Throws InputError where the object has a name that is not known. It serves files that only this project writes: a
/// damaged name would otherwise look like an optional value that is missing.
void require_known_names(const nlohmann::json& object, const std::vector<std::string>& known, const std::string& where);

double json_number(const nlohmann::json& object, const std::string& key, const std::string& where);
int json_integer(const nlohmann::json& object, const std::string& key, const std::string& where);

/// Reads `count` finite numbers.
std::vector<double> json_numbers(const nlohmann::json& object, const std::string& key, std::size_t count,
                                 const std::string& where);

}  // namespace houghstream
