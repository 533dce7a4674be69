#include "drivers/datasets/bop_source.hpp"

#include "drivers/datasets/bop_dataset.hpp"

namespace houghstream {
namespace {

class BopSource : public FrameSource {
 public:
  explicit BopSource(const std::filesystem::path& folder) : scene_(folder) {}

  std::optional<RgbdFrame> next() override {
    if (index_ == scene_.images().size()) return std::nullopt;
    return scene_.read_frame(index_++);
  }

  double rate_hz() const override { return kDatasetRateHz; }

 private:
  BopScene scene_;
  std::size_t index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_bop_source(const std::filesystem::path& folder) {
  return std::make_unique<BopSource>(folder);
}

}  // namespace houghstream
