#include "drivers/render_source.hpp"

#include "drivers/bop_dataset.hpp"
#include "drivers/synth/scene_frames.hpp"

namespace houghstream {
namespace {

class RenderSource : public FrameSource {
 public:
  explicit RenderSource(const std::string& name)
      : scene_(make_named_scene(name)), lit_world_(light_world(scene_.world)) {}

  std::optional<RgbdFrame> next() override {
    if (index_ == kRenderSourceFrames) return std::nullopt;
    RgbdFrame frame = render_scene_frame(scene_, lit_world_, index_, kRenderSourceFrames).frame;
    frame.utime = dataset_utime(static_cast<std::size_t>(index_));
    ++index_;
    return frame;
  }

  double rate_hz() const override { return 30.0; }

 private:
  Scene scene_;
  LitWorld lit_world_;
  int index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_render_source(const std::string& name) {
  return std::make_unique<RenderSource>(name);
}

}  // namespace houghstream
