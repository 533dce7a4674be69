#include "tools/common/command_errors.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "pipeline/base/printable.hpp"

namespace houghstream {
namespace {

/// Returns the number of letters to change, add or remove (Levenshtein 1966).
std::size_t edits_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

/// Returns the one of `words` that is nearest to `word`; empty where there are none.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
  const auto nearest = std::min_element(words.begin(), words.end(), [&](const std::string& a, const std::string& b) {
    return edits_between(a, word) < edits_between(b, word);
  });
  return nearest == words.end() ? "" : *nearest;
}

/// Returns the one of `words` that `word` is likely a misspelling of: less than half of its letters differ. Empty
/// without one.
std::string suggest_word(const std::string& word, const std::vector<std::string>& words) {
  const std::string nearest = nearest_word(word, words);
  return 2 * edits_between(nearest, word) < word.size() ? nearest : "";
}

bool is_of(const CLI::ParseError& error, CLI::ExitCodes kind) {
  return error.get_exit_code() == static_cast<int>(kind);
}

/// Words that a command has no place for.
std::vector<std::string> left_over(const CLI::App& command) {
  std::vector<std::string> words = command.remaining();
  words.erase(std::remove(words.begin(), words.end(), "--"), words.end());
  return words;
}

/// Returns the first command that has words left over, else the last one that is given.
const CLI::App& faulty_command(const CLI::App& app) {
  const CLI::App* command = &app;
  while (left_over(*command).empty() && !command->get_subcommands().empty())
    command = command->get_subcommands().front();
  return *command;
}

/// Returns the command as a person types it: "hs-log export".
std::string title_of(const CLI::App& command) {
  std::string title = command.get_name();
  for (const CLI::App* parent = command.get_parent(); parent != nullptr; parent = parent->get_parent())
    title.insert(0, parent->get_name() + " ");
  return title;
}

std::string commands_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* each : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(each->get_name());
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<std::string> long_names(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options)
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  return names;
}

std::string unknown_option(const CLI::App& command, const std::string& word) {
  const std::string option = word.substr(0, word.find('='));
  const std::size_t begin = option.find_first_not_of('-');
  const std::string meant =
      begin == std::string::npos ? "" : suggest_word(option.substr(begin), long_names(command.get_options()));
  return fmt::format("unknown option {}{} (--help lists all)", option,
                     meant.empty() ? "" : fmt::format(", did you mean --{}?", meant));
}

std::string unknown_word(const CLI::App& command, const std::string& word) {
  if (word.size() > 1 && word.front() == '-') return unknown_option(command, word);
  const std::string commands = commands_of(command);
  if (!commands.empty() && command.get_subcommands().empty())
    return fmt::format("unknown command '{}', expected {}", word, commands);
  return fmt::format("'{}' is one word too many (--help lists what is expected)", word);
}

std::string config_file(const CLI::App& app) {
  return app.get_config_ptr()->results().back();
}

/// Returns the fault of a key. CLI11's own message names the key first where it is an option that no file may set, else
/// last.
std::string fault_of_key(const CLI::App& app, const std::string& words) {
  const std::size_t colon = words.find(": This option");
  const std::string key = colon == std::string::npos ? words.substr(words.find("parse ") + 6) : words.substr(0, colon);
  const auto is_key = [](const CLI::Option* option) { return option->get_configurable(); };
  return fmt::format("{}: '{}' is no key, expected one of the options' long names; the nearest is '{}'",
                     config_file(app), key, nearest_word(key, long_names(app.get_options(is_key))));
}

/// Returns whether an error about an option, with whose name it begins, is about a value of the configuration file.
bool is_about_config(const CLI::App& app, const std::string& words) {
  const CLI::Option* option = app.get_option_no_throw(words.substr(0, words.find(':')));
  if (option == nullptr || option->count() == 0) return false;
  if (app.get_config_ptr() == nullptr || app.get_config_ptr()->count() != 1) return false;
  const std::vector<CLI::Option*>& typed = app.parse_order();
  return std::find(typed.begin(), typed.end(), option) == typed.end();
}

/// Returns the fault of an option. CLI11's message about an option begins with its name, except where it is a flag that
/// is neither true nor false.
std::string fault_of_option(const std::string& words, const CLI::ParseError& error) {
  if (is_of(error, CLI::ExitCodes::ExcludesError)) {
    const std::string between = " excludes ";
    const std::size_t end = words.find(between);
    return fmt::format("{} and {}, expected at most one of them", words.substr(0, end),
                       words.substr(end + between.size()));
  }
  const std::string name = words.substr(0, words.find(':'));
  if (is_of(error, CLI::ExitCodes::ArgumentMismatch)) {
    const bool is_repeated = words.find("At Most") != std::string::npos;
    return name + (is_repeated ? ": is given more than once" : ": without a value, expected one");
  }
  if (is_of(error, CLI::ExitCodes::ConversionError) && words.find(" = ") != std::string::npos) {
    const std::size_t equals = words.find(" = ");
    const std::size_t begin = words.find(": ") + 2;
    return fmt::format("{}: {}, expected true or false", words.substr(begin, equals - begin), words.substr(equals + 3));
  }
  return words;
}

std::string fault_of(const CLI::App& app, const CLI::App& command, const CLI::ParseError& error) {
  const std::string words = error.what();
  if (is_of(error, CLI::ExitCodes::ConfigError)) return fault_of_key(app, words);
  if (is_of(error, CLI::ExitCodes::FileError))
    return config_file(app) + ": cannot be read, expected a file of lines key = value";
  const bool is_missing = is_of(error, CLI::ExitCodes::RequiredError);
  const std::vector<std::string> others = left_over(command);
  // A missing option may be given misspelt.
  if (!others.empty() && (is_missing || is_of(error, CLI::ExitCodes::ExtrasError)))
    return unknown_word(command, others.front());
  if (is_missing && command.get_subcommands().size() < command.get_require_subcommand_min())
    return "without a command, expected " + commands_of(command);
  const std::string of_option = fault_of_option(words, error);
  return is_about_config(app, of_option) ? config_file(app) + ": " + of_option : of_option;
}

}  // namespace

std::string fault_line(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = faulty_command(app);
  return printable(fmt::format("{}: {}", title_of(command), fault_of(app, command, error)));
}

std::string config_fault_line(const CLI::App& app, const std::string& fault) {
  return printable(fmt::format("{}: {}: {}", app.get_name(), config_file(app), fault));
}

}  // namespace houghstream
