#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/settings_fields.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
class Option;
}  // namespace CLI

namespace houghstream {

/// An option that was added to a command line; every call returns the same option. Terms as in CLI11.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option* option) : option_(option) {}
  CommandOption& required();                             ///< it must be given, and its value not be empty
  CommandOption& capture_default_str();                  ///< help shows the value from before
  CommandOption& default_str(const std::string& words);  ///< help shows this instead
  CommandOption& description(const std::string& words);  ///< instead of the one that it was added with
  CommandOption& delimiter(char between);                ///< separates several values in one word
  CommandOption& range(int low, int high);               ///< both are allowed
  CommandOption& range(double low, double high);         ///< both are allowed
  CommandOption& range(const NumberRange& of_setting);   ///< range of the setting that the option changes
  CommandOption& positive();                             ///< above 0
  CommandOption& non_negative();                         ///< 0 or above
  CommandOption& one_of(const std::vector<int>& values);
  CommandOption& repeatable();                          ///< of a list: one value each time that the option is given
  CommandOption& excludes(const CommandOption& other);  ///< at most one of the two is given
  CommandOption& transform(const std::map<std::string, double>& values);  ///< a name becomes its value

 private:
  CLI::Option* option_;  // the command line's
};

/// A command line, or a subcommand of one, as CLI11 understands it; copies are the same command line. Only
/// command_line.cpp and command_errors.cpp include CLI11: each source that did would hold much of it again, and take
/// four seconds longer to compile.
class CommandLine {
 public:
  /// Makes a command line. `words` say in help what the executable `name` does.
  CommandLine(const std::string& words, const std::string& name);

  /// Adds an option. `names` are as in CLI11: "-s,--start", or "log" for an argument that is named by its place. The
  /// types are listed in command_line.cpp; an optional stays empty where the option is not given. Numbers are finite
  /// ones.
  template <typename T>
  CommandOption add_option(const std::string& names, T& value, const std::string& words = "");
  CommandOption add_flag(const std::string& names, bool& value, const std::string& words);
  /// Adds the option to this command and its subcommands so far, before or behind their names.
  void add_common_flag(const std::string& names, bool& value, const std::string& words);
  /// Adds a flag; `clears` becomes false where it is given.
  CommandOption add_clearing_flag(const std::string& names, bool& clears, const std::string& words);
  CommandOption get_option(const std::string& name);

  /// Adds `--config FILE`: a TOML file with the long names of all options as keys, `key = value`; the command line
  /// takes precedence. A key that is no option is refused with the nearest that is; a fault names the file.
  void add_config_file();
  /// Returns such a file with every option, its default and what it does; an option without a default stands behind a
  /// '#'.
  std::string config_template() const;

  /// Lets options behind the subcommand that are not its own be those of this command: -v.
  CommandLine add_subcommand(const std::string& name, const std::string& words);
  void require_subcommand();  ///< requires exactly one subcommand
  bool given() const;         ///< whether this subcommand was given

  /// Adds a command to the end of help, as a person types it; a subcommand has its own.
  void add_example(const std::string& command);

  std::string name() const;
  void set_version(const std::string& version);  ///< printed for --version
  /// Fills the options' values from `words`, without the executable's name. An exit status where that was all: 0
  /// after help or version, which go to stdout, 2 after a fault of the words, whose one line goes to stderr.
  std::optional<int> parse(const std::vector<std::string>& words);

 private:
  explicit CommandLine(std::shared_ptr<CLI::App> app) : app_(std::move(app)) {}
  std::shared_ptr<CLI::App> app_;
};

}  // namespace houghstream
