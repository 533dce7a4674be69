#pragma once

#include <algorithm>
#include <opencv2/core.hpp>

#include "detector/features/line_allocator.hpp"

namespace houghstream {

/// Memory for a picture that is made again and again in several sizes: cv::Mat would ask for other memory each time.
class PictureMemory {
 public:
  /// What it shows is what was there before; it ends with the next one, and with the memory.
  cv::Mat picture(cv::Size size, int type) {
    const std::size_t bytes = static_cast<std::size_t>(size.area()) * CV_ELEM_SIZE(type);
    if (bytes_.size() < bytes) bytes_.resize(bytes);
    return {size, type, bytes_.data()};
  }

 private:
  LineBytes bytes_;
};

/// Before an image is written anew: what somebody else looks at as well gets a place of its own.
inline void forget_shared(cv::Mat& image) {
  if (image.u == nullptr || image.u->refcount > 1) image.release();
}

}  // namespace houghstream
