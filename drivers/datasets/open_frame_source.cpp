#include "drivers/datasets/open_frame_source.hpp"

#include <filesystem>

#include "drivers/datasets/dataset_sources.hpp"
#include "drivers/files/frame_folder.hpp"
#include "drivers/ros_bag/bag_source.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/require_folder.hpp"

namespace houghstream {
namespace {

bool is_folder(const std::string& name) {
  std::error_code unknown;
  return std::filesystem::is_directory(name, unknown);
}

bool is_bop_scene(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "scene_camera.json");
}

/// Returns the first scene folder in a folder, by name; empty where there is none.
std::string scene_in(const std::filesystem::path& folder) {
  std::error_code unknown;
  std::string first;
  for (const auto& entry : std::filesystem::directory_iterator(folder, unknown)) {
    if (is_bop_scene(entry.path()) && (first.empty() || entry.path().string() < first)) first = entry.path().string();
  }
  return first;
}

std::unique_ptr<FrameSource> open_bop_folder(const std::string& folder) {
  require_folder(folder, "a BOP scene folder");
  if (!is_bop_scene(folder)) {
    const std::string scene = scene_in(folder);
    fail("{}: no scene_camera.json in it, expected a BOP scene folder{}", folder,
         scene.empty() ? "" : fmt::format("; bop:{} is one", scene));
  }
  return open_bop_source(folder);
}

/// Opens "DIR" or "DIR,WIDTHxHEIGHT,fx,fy,cx,cy". A folder's name may hold commas too: the longest that is there
/// counts.
template <typename Open>
std::unique_ptr<FrameSource> open_with_camera(const std::string& value, const Open& open) {
  // The depth sensor's nominal camera is the one that readers of these datasets assume; the datasets themselves state
  // none.
  const Camera nominal{640, 480, 525.0, 525.0, 319.5, 239.5};
  std::string folder = value;
  while (!is_folder(folder) && folder.find(',') != std::string::npos) folder.resize(folder.rfind(','));
  if (folder == value || !is_folder(folder)) return open(value, nominal);
  return open(folder, parse_camera(value.substr(folder.size() + 1)));
}

}  // namespace

std::unique_ptr<FrameSource> open_frame_source(const std::string& specification, const std::string& others) {
  const std::size_t colon = specification.find(':');
  const std::string kind = specification.substr(0, colon);
  const std::string value = colon == std::string::npos ? "" : specification.substr(colon + 1);
  if (kind == "bop" && !value.empty()) return open_bop_folder(value);
  if (kind == "uw" && !value.empty()) return open_with_camera(value, open_uw_source);
  if (kind == "tum" && !value.empty()) return open_with_camera(value, open_tum_source);
  if (kind == "bag" && !value.empty()) return ros_bag::open_bag_source(value);
  const std::string meant = suggest_source(specification);
  fail("source '{}', expected {}bop:DIR, uw:DIR, tum:DIR or bag:FILE{}", specification, others,
       meant.empty() ? "" : fmt::format("; did you mean {}?", meant));
}

std::string suggest_source(const std::string& place) {
  const std::filesystem::path path(place);
  if (is_folder(place)) {
    if (is_bop_scene(path)) return "bop:" + place;
    if (std::filesystem::exists(path / "depth.txt")) return "tum:" + place;
    return has_frame_pairs(path) ? "uw:" + place : "";
  }
  if (!std::filesystem::exists(path)) return "";
  for (const char* kind : {"bag", "oni"}) {
    if (path.extension() == std::string(".") + kind) return fmt::format("{}:{}", kind, place);
  }
  return "";
}

void require_outside_source(const std::filesystem::path& output, const std::string& specification) {
  require_other_file(output, specification);
  const std::size_t colon = specification.find(':');
  if (colon == std::string::npos) return;
  const std::string place = specification.substr(colon + 1);
  require_other_file(output, place);
  for (std::size_t comma = place.find(','); comma != std::string::npos; comma = place.find(',', comma + 1))
    require_other_file(output, place.substr(0, comma));  // DIR,CAMERA
}

}  // namespace houghstream
