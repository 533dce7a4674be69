#include "drivers/files/frame_folder.hpp"

#include <algorithm>

#include "drivers/files/image_file.hpp"
#include "drivers/files/natural_order.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/require_folder.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool is_depth(const std::string& file) {
  return ends_with(file, "_depth.png") || ends_with(file, "-depth.png");
}

bool is_image(const std::string& file) {
  return ends_with(file, "_color.png") || ends_with(file, "-color.png");
}

fs::path colour_partner(const fs::path& folder, const std::string& name) {
  for (const char* end : {"_color.png", "-color.png", ".png"}) {
    if (fs::exists(folder / (name + end))) return folder / (name + end);
  }
  fail("{}: no picture for depth image {}, expected {}_color.png or {}.png", folder.string(), name, name, name);
}

}  // namespace

bool has_frame_pairs(const fs::path& folder) {
  const auto is_frame = [](const fs::directory_entry& entry) {
    const std::string file = entry.path().filename().string();
    return is_depth(file) || is_image(file);
  };
  return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(), is_frame);
}

std::vector<FrameFiles> list_frame_pairs(const fs::path& folder) {
  require_folder(folder, "images");
  std::vector<FrameFiles> pairs;
  std::size_t images = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (is_image(file)) ++images;
    if (!is_depth(file)) continue;
    const std::string name = file.substr(0, file.size() - std::string("_depth.png").size());
    pairs.push_back({name, colour_partner(folder, name), entry.path()});
  }
  require(!pairs.empty(), "{}: no images, expected NAME_color.png or NAME.png with NAME_depth.png", folder.string());
  require(images <= pairs.size(), "{}: {} colour images and {} depth images, expected pairs", folder.string(), images,
          pairs.size());
  std::sort(pairs.begin(), pairs.end(),
            [](const FrameFiles& a, const FrameFiles& b) { return natural_less(a.name, b.name); });
  return pairs;
}

std::vector<fs::path> list_frame_folders(const fs::path& folder) {
  require_folder(folder, "images");
  std::vector<fs::path> folders;
  if (has_frame_pairs(folder)) folders.push_back(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory() && has_frame_pairs(entry.path())) folders.push_back(entry.path());
  }
  require(!folders.empty(), "{}: no images here or below, expected NAME_color.png or NAME.png with NAME_depth.png",
          folder.string());
  std::sort(folders.begin(), folders.end(),
            [](const fs::path& a, const fs::path& b) { return natural_less(a.string(), b.string()); });
  return folders;
}

RgbdFrame read_frame_pair(const FrameFiles& pair, const Camera& camera, std::int64_t utime) {
  RgbdFrame frame;
  frame.id.utime = utime;
  frame.camera = camera;
  frame.colour = read_colour_image(pair.colour);
  frame.depth = depth_from_millimetres(read_depth_image(pair.depth));
  check_frame(frame, pair.colour.string());
  return frame;
}

}  // namespace houghstream
