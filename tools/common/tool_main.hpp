#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/common/command_line.hpp"

namespace houghstream {

/// Runs an executable with what all have in common: -h, --version, -v, the log on stderr under the tool's name, and
/// errors as one line with exit status 2 for the command line (UsageError), else 1.
int run_tool(CommandLine& line, int argc, char** argv, const std::function<void()>& body);

/// Prints a value for scripts, which read it whole: indented by two, names in their order, what is no UTF-8 replaced.
void print_json(const nlohmann::ordered_json& json);

/// Adds the option -l, --lcm-url, the same for every process.
void add_lcm_url_option(CommandLine& line, std::string& url);

/// Adds the option --replace of every program that records; `recordings` names the options that it is about. Without it
/// a recording whose name is taken gets the next number.
void add_replace_option(CommandLine& line, bool& replace, const std::string& recordings);

/// Adds the option -c, --channel of every tool that takes frames off the bus or out of a log: a ChannelPattern.
CommandOption add_frame_channels_option(CommandLine& line, std::string& channels);

/// Adds the options --models and --model-unit of tools that read models; `unit_m` becomes the unit's length in metres.
void add_model_options(CommandLine& line, std::string& models, double& unit_m);

}  // namespace houghstream
