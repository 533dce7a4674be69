#include "drivers/datasets/uw_source.hpp"

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/frame_folder.hpp"

namespace houghstream {
namespace {

class UwSource : public FrameSource {
 public:
  UwSource(const std::filesystem::path& folder, const Camera& camera)
      : pairs_(list_frame_pairs(folder)), camera_(camera) {}

  std::optional<RgbdFrame> next() override {
    if (index_ == pairs_.size()) return std::nullopt;
    const std::size_t index = index_++;
    return read_frame_pair(pairs_[index], camera_, dataset_utime(index));
  }

  double rate_hz() const override { return kDatasetRateHz; }

 private:
  std::vector<FramePair> pairs_;
  Camera camera_;
  std::size_t index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_uw_source(const std::filesystem::path& folder, const Camera& camera) {
  return std::make_unique<UwSource>(folder, camera);
}

}  // namespace houghstream
