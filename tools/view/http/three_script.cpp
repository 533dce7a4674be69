#include "tools/view/http/three_script.hpp"

#include <fstream>
#include <iterator>

namespace houghstream::view {

std::optional<std::string> read_three_script(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) continue;
    std::ifstream in(file, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in.bad() && !text.empty()) return text;
  }
  return std::nullopt;
}

}  // namespace houghstream::view
