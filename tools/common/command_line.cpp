#include "tools/common/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <sstream>
#include <type_traits>

#include "pipeline/base/checks.hpp"
#include "tools/common/command_errors.hpp"
#include "tools/common/key_values.hpp"

namespace houghstream {
namespace {

/// The configuration file's format. CLI11's own passes over what it does not understand.
class KeyValueConfig : public CLI::ConfigBase {
 public:
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
    std::vector<CLI::ConfigItem> read;
    for (const KeyValue& line : read_key_values(input)) {
      read.emplace_back();
      read.back().name = line.key;
      read.back().inputs = {line.value};
    }
    return read;
  }
};

/// Returns a word as an error line shows it.
std::string said(const std::string& word) {
  return word.empty() ? "nothing" : word;
}

/// Type of an option's value, also where the option may have none.
template <typename T>
struct Held {
  using Type = T;
};

template <typename T>
struct Held<std::optional<T>> {
  using Type = T;
};

/// Returns why `word` is no number that an option of this type can have; empty where it is one. No option can have NaN,
/// with which no comparison holds, or infinity.
template <typename T>
std::string fault_of_number(const std::string& word) {
  T value{};
  errno = 0;
  const bool is_number = CLI::detail::lexical_cast(word, value);
  if constexpr (std::is_floating_point_v<T>) {
    if (is_number && std::isfinite(value)) return "";
    return fmt::format("{}, expected a {}number", said(word), is_number ? "finite " : "");
  } else {
    // The library stops at the greatest number, and takes -1 for the greatest that has no sign.
    const bool is_other = errno == ERANGE || (std::is_unsigned_v<T> && word.find('-') != std::string::npos);
    if (is_number && !is_other) return "";
    if (word.empty() || word.find_first_not_of("+-0123456789") != std::string::npos)
      return fmt::format("{}, expected a whole number", said(word));
    return fmt::format("{}, expected a whole number from {} to {}", word, std::numeric_limits<T>::min(),
                       std::numeric_limits<T>::max());
  }
}

/// Refuses numbers that do not fit; help and the refusal say what is `expected`.
template <typename T, typename Fits>
void check_number(CLI::Option& option, const std::string& expected, Fits fits) {
  const auto fault = [expected, fits](const std::string& word) {
    T value{};
    if (CLI::detail::lexical_cast(word, value) && fits(value)) return std::string();
    return fmt::format("{}, expected {}", said(word), expected);
  };
  option.check(fault, expected);
}

template <typename T>
void check_range(CLI::Option& option, T low, T high) {
  check_number<T>(option, fmt::format("{} to {}", low, high),
                  [low, high](T value) { return value >= low && value <= high; });
}

std::vector<CLI::App*> subcommands_of(CLI::App& app) {
  return app.get_subcommands([](CLI::App*) { return true; });
}

/// Keeps the options of all subcommands out of a configuration file, whose keys are those of the whole line only.
void exclude_subcommands_from_config(CLI::App& app) {
  for (CLI::App* subcommand : subcommands_of(app)) {
    for (CLI::Option* option : subcommand->get_options()) option->configurable(false);
    exclude_subcommands_from_config(*subcommand);
  }
}

}  // namespace

CommandOption& CommandOption::required() {
  const auto is_missing = [](const std::string& word) {
    return word.empty() ? said(word) + ", expected a value" : std::string();
  };
  option_->required()->check(is_missing);
  return *this;
}

CommandOption& CommandOption::capture_default_str() {
  option_->capture_default_str();
  return *this;
}

CommandOption& CommandOption::default_str(const std::string& words) {
  option_->default_str(words);
  return *this;
}

CommandOption& CommandOption::description(const std::string& words) {
  option_->description(words);
  return *this;
}

CommandOption& CommandOption::delimiter(char between) {
  option_->delimiter(between);
  return *this;
}

CommandOption& CommandOption::range(int low, int high) {
  check_range(*option_, low, high);
  return *this;
}

CommandOption& CommandOption::range(double low, double high) {
  check_range(*option_, low, high);
  return *this;
}

CommandOption& CommandOption::range(const NumberRange& of_setting) {
  return range(of_setting.min, of_setting.max);
}

CommandOption& CommandOption::positive() {
  check_number<double>(*option_, "a number above 0", [](double value) { return value > 0.0; });
  return *this;
}

CommandOption& CommandOption::non_negative() {
  check_number<double>(*option_, "0 or a number above", [](double value) { return value >= 0.0; });
  return *this;
}

CommandOption& CommandOption::one_of(const std::vector<int>& values) {
  check_number<int>(*option_, fmt::format("one of {}", fmt::join(values, ", ")),
                    [values](int value) { return std::find(values.begin(), values.end(), value) != values.end(); });
  return *this;
}

CommandOption& CommandOption::repeatable() {
  option_->allow_extra_args(false);
  return *this;
}

CommandOption& CommandOption::excludes(const CommandOption& other) {
  option_->excludes(other.option_);
  return *this;
}

CommandOption& CommandOption::transform(const std::map<std::string, double>& values) {
  std::vector<std::string> names;
  names.reserve(values.size());
  for (const auto& entry : values) names.push_back(entry.first);
  const std::string expected = fmt::format("one of {}", fmt::join(names, ", "));
  const auto replace = [values, expected](std::string& word) {
    const auto found = values.find(word);
    if (found == values.end()) return fmt::format("{}, expected {}", said(word), expected);
    word = fmt::format("{}", found->second);
    return std::string();
  };
  option_->transform(CLI::Validator(replace, expected));
  return *this;
}

CommandLine::CommandLine(const std::string& words, const std::string& name)
    : app_(std::make_shared<CLI::App>(words, name)) {}

template <typename T>
CommandOption CommandLine::add_option(const std::string& names, T& value, const std::string& words) {
  CLI::Option* option = app_->add_option(names, value, words);
  using Number = typename Held<T>::Type;
  if constexpr (std::is_arithmetic_v<Number>)
    option->check([](const std::string& word) { return fault_of_number<Number>(word); });
  return CommandOption(option);
}

template CommandOption CommandLine::add_option(const std::string&, int&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::int64_t&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::uint64_t&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, float&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, double&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::string&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::filesystem::path&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::optional<int>&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::optional<std::int64_t>&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::optional<float>&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::optional<double>&, const std::string&);
template CommandOption CommandLine::add_option(const std::string&, std::optional<std::string>&, const std::string&);

CommandOption CommandLine::add_flag(const std::string& names, bool& value, const std::string& words) {
  return CommandOption(app_->add_flag(names, value, words));
}

void CommandLine::add_common_flag(const std::string& names, bool& value, const std::string& words) {
  std::vector<CLI::App*> commands = {app_.get()};
  for (std::size_t i = 0; i < commands.size(); ++i) {
    commands[i]->add_flag(names, value, words);
    const std::vector<CLI::App*> jobs = subcommands_of(*commands[i]);
    commands.insert(commands.end(), jobs.begin(), jobs.end());
  }
}

CommandOption CommandLine::add_clearing_flag(const std::string& names, bool& clears, const std::string& words) {
  return CommandOption(app_->add_flag_callback(
      names, [&clears] { clears = false; }, words));
}

CommandOption CommandLine::get_option(const std::string& name) {
  return CommandOption(app_->get_option(name));
}

void CommandLine::add_config_file() {
  app_->set_config("--config", "", "TOML file of these options (see init): key = value")->configurable(false);
  app_->allow_config_extras(CLI::config_extras_mode::error);
  app_->config_formatter(std::make_shared<KeyValueConfig>());
  app_->get_help_ptr()->configurable(false);
}

std::string CommandLine::config_template() const {
  exclude_subcommands_from_config(*app_);
  const std::string unset = "=\"\"";
  std::istringstream lines(app_->config_to_str(true, true));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const bool is_unset = line.size() > unset.size() && line.front() != '#' &&
                          line.compare(line.size() - unset.size(), unset.size(), unset) == 0;
    text += (is_unset ? "# " : "") + line + "\n";
  }
  return text;
}

CommandLine CommandLine::add_subcommand(const std::string& name, const std::string& words) {
  CLI::App* job = app_->add_subcommand(name, words);
  job->footer(std::string());       // a command has no footer of the whole line
  return CommandLine({app_, job});  // lives as long as the whole line
}

void CommandLine::add_example(const std::string& command) {
  const std::string before = app_->get_footer();
  app_->footer((before.empty() ? "Examples:" : before) + "\n  $ " + command);
}

void CommandLine::require_subcommand() {
  app_->require_subcommand(1);
}

bool CommandLine::given() const {
  return app_->parsed();
}

std::string CommandLine::name() const {
  return app_->get_name();
}

void CommandLine::set_version(const std::string& version) {
  app_->set_version_flag("--version", version);
}

std::optional<int> CommandLine::parse(const std::vector<std::string>& words) {
  constexpr int kUsageError = 2;  // exit status as of bash's builtins and of argparse
  try {
    app_->parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes the last one first
    return std::nullopt;
  } catch (const CLI::Success& end) {
    return app_->exit(end);
  } catch (const CLI::ParseError& error) {
    std::cerr << fault_line(*app_, error) << "\n";
    return kUsageError;
  } catch (const InputError& error) {  // error in a line of the configuration file
    std::cerr << config_fault_line(*app_, error.what()) << "\n";
    return kUsageError;
  }
}

}  // namespace houghstream
