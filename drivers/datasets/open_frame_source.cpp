#include "drivers/datasets/open_frame_source.hpp"

#include <filesystem>

#include "drivers/datasets/dataset_sources.hpp"
#include "drivers/ros_bag/bag_source.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"

namespace houghstream {
namespace {

bool is_folder(const std::string& name) {
  std::error_code unknown;
  return std::filesystem::is_directory(name, unknown);
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
  if (kind == "bop" && !value.empty()) return open_bop_source(value);
  if (kind == "uw" && !value.empty()) return open_with_camera(value, open_uw_source);
  if (kind == "tum" && !value.empty()) return open_with_camera(value, open_tum_source);
  if (kind == "bag" && !value.empty()) return ros_bag::open_bag_source(value);
  fail("source '{}', expected {}bop:DIR, uw:DIR, tum:DIR or bag:FILE", specification, others);
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
