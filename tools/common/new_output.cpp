#include "tools/common/new_output.hpp"

#include <fmt/format.h>

#include <system_error>

#include "pipeline/base/checks.hpp"

namespace houghstream {

void add_replace_output_option(CommandLine& line, bool& replace, const std::string& outputs) {
  line.add_flag("--replace", replace,
                fmt::format("replaces {}, once the new one is whole; without, one that is there is refused", outputs));
}

void require_new_output(const std::filesystem::path& file, bool replace) {
  std::error_code unknown;
  require(replace || !std::filesystem::is_regular_file(file, unknown),
          "{}: is there already, expected a new name, or --replace to put the new one in its place", file.string());
}

}  // namespace houghstream
