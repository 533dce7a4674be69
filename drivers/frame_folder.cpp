#include "drivers/frame_folder.hpp"

#include <algorithm>

#include "drivers/image_file.hpp"
#include "drivers/natural_order.hpp"
#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

fs::path colour_partner(const fs::path& folder, const std::string& name) {
  for (const char* end : {"_color.png", "-color.png", ".png"}) {
    if (fs::exists(folder / (name + end))) return folder / (name + end);
  }
  fail("{}: no picture for depth image {}, expected {}_color.png or {}.png", folder.string(), name, name, name);
}

}  // namespace

std::vector<FramePair> list_frame_pairs(const fs::path& folder) {
  require(fs::is_directory(folder), "{}: no such folder, expected images", folder.string());
  std::vector<FramePair> pairs;
  std::size_t pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (ends_with(file, "_color.png") || ends_with(file, "-color.png")) ++pictures;
    if (!ends_with(file, "_depth.png") && !ends_with(file, "-depth.png")) continue;
    const std::string name = file.substr(0, file.size() - std::string("_depth.png").size());
    pairs.push_back({name, colour_partner(folder, name), entry.path()});
  }
  require(!pairs.empty(), "{}: no images, expected NAME_color.png or NAME.png with NAME_depth.png", folder.string());
  require(pictures <= pairs.size(), "{}: {} colour images and {} depth images, expected pairs", folder.string(),
          pictures, pairs.size());
  std::sort(pairs.begin(), pairs.end(),
            [](const FramePair& a, const FramePair& b) { return natural_less(a.name, b.name); });
  return pairs;
}

RgbdFrame read_frame_pair(const FramePair& pair, const Camera& camera, std::int64_t utime) {
  RgbdFrame frame;
  frame.utime = utime;
  frame.camera = camera;
  frame.colour = read_colour_image(pair.colour);
  frame.depth = depth_from_millimetres(read_depth_image(pair.depth));
  check_frame(frame, pair.colour.string());
  return frame;
}

}  // namespace houghstream
