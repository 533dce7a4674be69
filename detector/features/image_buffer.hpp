#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <opencv2/core.hpp>
#include <vector>

namespace houghstream {

/// Allocator of memory that begins with a cache line, so that aligned pixels and vectors lie in one line each.
template <typename T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <typename U>
  explicit LineAllocator(const LineAllocator<U>&) {}

  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, kLine); }

  bool operator==(const LineAllocator&) const { return true; }
  bool operator!=(const LineAllocator&) const { return false; }
};

using LineBytes = std::vector<std::uint8_t, LineAllocator<std::uint8_t>>;

/// Memory of an image that is made repeatedly in several sizes: cv::Mat would reallocate it each time.
class ImageBuffer {
 public:
  /// Returns an image with undefined content, which is valid until the next call and while the buffer exists.
  cv::Mat image(cv::Size size, int type) {
    const std::size_t bytes = static_cast<std::size_t>(size.area()) * CV_ELEM_SIZE(type);
    if (bytes_.size() < bytes) bytes_.resize(bytes);
    return {size, type, bytes_.data()};
  }

 private:
  LineBytes bytes_;
};

/// Releases an image whose pixels are shared, or are not its own, so that writing it changes no other image.
inline void forget_shared(cv::Mat& image) {
  if (image.u == nullptr || image.u->refcount > 1) image.release();
}

// The names of before, for one release.
using PictureMemory [[deprecated("is ImageBuffer now")]] = ImageBuffer;

}  // namespace houghstream
