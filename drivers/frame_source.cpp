#include "drivers/frame_source.hpp"

#include "drivers/datasets/dataset_sources.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"

namespace houghstream {
namespace {

/// Opens "DIR" or "DIR,WIDTHxHEIGHT,fx,fy,cx,cy".
template <typename Open>
std::unique_ptr<FrameSource> open_with_camera(const std::string& value, const Open& open) {
  // The depth sensor's nominal camera, which readers of these datasets assume; the datasets themselves state none.
  const Camera nominal{640, 480, 525.0, 525.0, 319.5, 239.5};
  const std::size_t comma = value.find(',');
  if (comma == std::string::npos) return open(value, nominal);
  return open(value.substr(0, comma), parse_camera(value.substr(comma + 1)));
}

}  // namespace

std::unique_ptr<FrameSource> open_frame_source(const std::string& specification) {
  const std::size_t colon = specification.find(':');
  const std::string kind = specification.substr(0, colon);
  const std::string value = colon == std::string::npos ? "" : specification.substr(colon + 1);
  if (kind == "bop" && !value.empty()) return open_bop_source(value);
  if (kind == "uw" && !value.empty()) return open_with_camera(value, open_uw_source);
  if (kind == "tum" && !value.empty()) return open_with_camera(value, open_tum_source);
  fail("source '{}', expected bop:DIR, uw:DIR or tum:DIR", specification);
}

void require_outside_source(const std::filesystem::path& output, const std::string& specification) {
  require_other_file(output, specification);
  const std::size_t colon = specification.find(':');
  if (colon == std::string::npos) return;
  const std::string place = specification.substr(colon + 1);
  require_other_file(output, place);
  require_other_file(output, place.substr(0, place.find(',')));  // DIR,CAMERA
}

}  // namespace houghstream
