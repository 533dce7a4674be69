#include "tools/common/tool_main.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "pipeline/base/log_line.hpp"
#include "pipeline/base/printable.hpp"
#include "pipeline/base/terminal_colour.hpp"
#include "tools/common/usage_error.hpp"

namespace houghstream {

int run_tool(CommandLine& line, int argc, char** argv, const std::function<void()>& body) {
  bool verbose = false;
  line.add_common_flag("-v,--verbose", verbose, "log more");
  line.set_version(line.name() + " " + HOUGHSTREAM_VERSION);
  if (const std::optional<int> status = line.parse({argv + 1, argv + argc})) return *status;
  start_log(line.name(), verbose ? LogLevel::kDebug : LogLevel::kInfo);
  constexpr int kFailed = 1;
  constexpr int kMisused = 2;
  try {
    body();
    return 0;
  } catch (const std::exception& error) {
    const std::string name = in_colour(line.name() + ":", TerminalColour::kRed, shows_colours(STDERR_FILENO));
    fmt::print(stderr, "{} {}\n", name, printable_lines(error.what()));
    return dynamic_cast<const UsageError*>(&error) != nullptr ? kMisused : kFailed;
  }
}

void print_json(const nlohmann::ordered_json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void add_lcm_url_option(CommandLine& line, std::string& url) {
  line.add_option("-l,--lcm-url", url, "default $LCM_DEFAULT_URL, else udpm with ttl=0");
}

void add_replace_option(CommandLine& line, bool& replace, const std::string& recordings) {
  line.add_flag("--replace", replace,
                fmt::format("with {}: replaces what is there; without, it stays and the new one is NAME_2, NAME_3, ...",
                            recordings));
}

CommandOption add_frame_channels_option(CommandLine& line, std::string& channels) {
  return line
      .add_option("-c,--channel", channels,
                  "channels of the cameras' frames: a regular expression for the whole name, for instance "
                  "'LEFT|RIGHT'")
      .capture_default_str();
}

void add_model_options(CommandLine& line, std::string& models, double& unit_m) {
  line.add_option("--models", models,
                  "models/ folder of a BOP dataset or of hs-fuse, or a folder of NAME.ply, NAME.obj");
  line.add_option("--model-unit", unit_m, "unit of the models' coordinates: mm (default), cm or m")
      .transform({{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}})
      .default_str("mm");
}

}  // namespace houghstream
