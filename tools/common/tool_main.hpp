#pragma once

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <string>

namespace houghstream {

/// What every executable shares: -h, --version, -v, the log on stderr under the tool's name, and its way to fail: one
/// clear line and a non-zero exit status.
inline int run_tool(CLI::App& app, int argc, char** argv, const std::function<void()>& body) {
  bool verbose = false;
  app.add_flag("-v,--verbose", verbose, "log more");
  app.set_version_flag("--version", app.get_name() + " " + HOUGHSTREAM_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  spdlog::set_default_logger(spdlog::stderr_color_mt(app.get_name()));
  spdlog::set_pattern("%H:%M:%S.%e %n: %v");
  spdlog::set_level(verbose ? spdlog::level::debug : spdlog::level::info);
  try {
    body();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return 1;
  }
}

/// The option -l, --lcm-url, the same for every process.
inline void add_lcm_url_option(CLI::App& app, std::string& url) {
  app.add_option("-l,--lcm-url", url, "LCM URL; default $LCM_DEFAULT_URL, else udpm with ttl=0");
}

/// The options --models and --model-unit of tools that read models; `unit_m` becomes the unit's length in metres.
inline void add_model_options(CLI::App& app, std::string& models, double& unit_m) {
  const std::map<std::string, double> units = {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}};
  app.add_option("--models", models,
                 "models/ folder of a BOP dataset or of hs-fuse, or a folder of NAME.ply, NAME.obj");
  app.add_option("--model-unit", unit_m, "unit of the models' coordinates: mm (default), cm or m")
      ->transform(CLI::CheckedTransformer(units))
      ->default_str("mm");
}

}  // namespace houghstream
