#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
class ParseError;
}  // namespace CLI

namespace houghstream {

/// Returns the line that reports an error of a command line, or of its configuration file: the program and its command,
/// the option or the word, and what was expected.
std::string fault_line(const CLI::App& app, const CLI::ParseError& error);

/// Describes an error of a line of the configuration file.
std::string config_fault_line(const CLI::App& app, const std::string& fault);

}  // namespace houghstream
