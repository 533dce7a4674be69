#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/terminal_colour.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/doctor/examination.hpp"

int main(int argc, char** argv) {
  using namespace houghstream;
  using namespace houghstream::doctor;
  CommandLine app(
      "Looks for what would keep the stream from working, and says how to mend it; changes nothing. Fails where the "
      "stream would not work.",
      "hs-doctor");
  ExaminationSettings settings;
  app.add_flag("--live", settings.live, "a camera is needed: without one the stream would not work");
  app.add_option("--width", settings.width, "pixels of a frame, where none is heard on the bus")
      .range(1, 16384)
      .capture_default_str();
  app.add_option("--height", settings.height, "pixels").range(1, 16384).capture_default_str();
  app.add_option("-c,--channel", settings.frame_channel, "channel of the frames").capture_default_str();
  bool json = false;
  app.add_flag("--json", json, "print it as JSON, for scripts");
  add_lcm_url_option(app, settings.lcm_url);
  app.add_example("hs-doctor");
  app.add_example("hs-doctor --live -c CAMERA_1");

  return run_tool(app, argc, argv, [&] {
    hush_log();  // the bus would warn of small buffers itself
    std::error_code unknown;
    const std::filesystem::path program_folder = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
    settings.programs = program_folder;
    settings.types_jar = program_folder / "houghstream_types.jar";
    if (!std::filesystem::exists(settings.types_jar))
      settings.types_jar = program_folder / "../share/java/houghstream_types.jar";
    const Findings findings = examine(this_machine(), settings);
    if (json) print_json(to_json(findings));
    if (!json) fmt::print("{}", to_text(findings, shows_colours(STDOUT_FILENO)));
    std::fflush(stdout);
    const int wrongs = count_wrong(findings);
    require(wrongs == 0, "the stream would not work: {} of the lines above", wrongs);
    if (!json) fmt::print("the stream works\n");
  });
}
