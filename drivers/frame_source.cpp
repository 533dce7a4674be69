#include "drivers/frame_source.hpp"

#include "drivers/bop_source.hpp"
#include "drivers/render_source.hpp"
#include "drivers/uw_source.hpp"
#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

/// "DIR" or "DIR,WIDTHxHEIGHT,fx,fy,cx,cy".
std::unique_ptr<FrameSource> open_uw(const std::string& value) {
  // The depth sensor's nominal camera, which readers of the dataset assume; the dataset itself states none.
  const Camera nominal{640, 480, 525.0, 525.0, 319.5, 239.5};
  const std::size_t comma = value.find(',');
  if (comma == std::string::npos) return open_uw_source(value, nominal);
  return open_uw_source(value.substr(0, comma), parse_camera(value.substr(comma + 1)));
}

}  // namespace

std::unique_ptr<FrameSource> open_frame_source(const std::string& specification) {
  const std::size_t colon = specification.find(':');
  const std::string kind = specification.substr(0, colon);
  const std::string value = colon == std::string::npos ? "" : specification.substr(colon + 1);
  if (kind == "bop" && !value.empty()) return open_bop_source(value);
  if (kind == "uw" && !value.empty()) return open_uw(value);
  if (kind == "render" && !value.empty()) return open_render_source(value);
  fail("source '{}', expected bop:DIR, uw:DIR or render:NAME", specification);
}

}  // namespace houghstream
