#include "pipeline/messages/codecs.hpp"

#include <libdeflate.h>
#include <turbojpeg.h>

#include <memory>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/image_decoding.hpp"

namespace houghstream {
namespace {

struct JpegDeleter {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using JpegHandle = std::unique_ptr<void, JpegDeleter>;

struct ZipDeleter {
  void operator()(libdeflate_compressor* zip) const { libdeflate_free_compressor(zip); }
  void operator()(libdeflate_decompressor* unzip) const { libdeflate_free_decompressor(unzip); }
};

// deflate cannot shrink more than this (zlib's technical page), so that a small stream cannot claim a large image.
constexpr std::size_t kMaxDeflateRatio = 1032;

void unzip_into(ByteView zipped, std::uint8_t* raw, std::size_t raw_size) {
  static thread_local const std::unique_ptr<libdeflate_decompressor, ZipDeleter> handle(
      libdeflate_alloc_decompressor());  // kept from frame to frame
  // Without a place for the unpacked size, libdeflate treats any size but raw_size as an error.
  const libdeflate_result result =
      libdeflate_zlib_decompress(handle.get(), zipped.data, zipped.size, raw, raw_size, nullptr);
  require(result != LIBDEFLATE_BAD_DATA, "zlib data of {} bytes is damaged or cut", zipped.size);
  require(result == LIBDEFLATE_SUCCESS, "zlib data of {} bytes unpacks to {} than the {} bytes expected", zipped.size,
          result == LIBDEFLATE_SHORT_OUTPUT ? "fewer" : "more", raw_size);
}

}  // namespace

void check_image_size(std::int64_t width, std::int64_t height) {
  require(width >= 1 && height >= 1 && width <= kMaxPixels && height <= kMaxPixels && width * height <= kMaxPixels,
          "image of {}x{} pixels, expected 1 to {} pixels in all", width, height, kMaxPixels);
}

std::vector<std::uint8_t> encode_jpeg(const cv::Mat& bgr, int quality) {
  require(quality >= 1 && quality <= 100, "JPEG quality {}, expected 1 to 100", quality);
  require(bgr.type() == CV_8UC3 && !bgr.empty(), "colour image of OpenCV type {} and {}x{} pixels, expected 8-bit BGR",
          bgr.type(), bgr.cols, bgr.rows);
  const JpegHandle handle(tjInitCompress());
  std::vector<std::uint8_t> jpeg(tjBufSize(bgr.cols, bgr.rows, TJSAMP_420));
  unsigned char* out = jpeg.data();
  unsigned long size = jpeg.size();
  const int failed = tjCompress2(handle.get(), bgr.data, bgr.cols, static_cast<int>(bgr.step), bgr.rows, TJPF_BGR, &out,
                                 &size, TJSAMP_420, quality, TJFLAG_NOREALLOC);
  require(failed == 0, "JPEG encoder: {}", tjGetErrorStr2(handle.get()));
  jpeg.resize(size);
  return jpeg;
}

cv::Mat decode_jpeg(ByteView jpeg, int width, int height) {
  check_image_size(width, height);
  const JpegHandle handle(tjInitDecompress());
  int found_width = 0;
  int found_height = 0;
  int subsampling = 0;
  int colour_space = 0;
  const int bad_header =
      tjDecompressHeader3(handle.get(), jpeg.data, jpeg.size, &found_width, &found_height, &subsampling, &colour_space);
  require(bad_header == 0, "JPEG of {} bytes cannot be read: {}", jpeg.size, tjGetErrorStr2(handle.get()));
  require(found_width == width && found_height == height, "JPEG of {}x{} pixels, the message says {}x{}", found_width,
          found_height, width, height);
  const int scans = count_jpeg_scans(jpeg.data, jpeg.size);
  require(scans <= kMaxScans, "JPEG of {} bytes with {} scans, expected at most {}", jpeg.size, scans, kMaxScans);
  cv::Mat bgr(height, width, CV_8UC3);
  // A cut stream is only a warning to the decoder, which fills the rest with grey: made-up values.
  const int failed = tjDecompress2(handle.get(), jpeg.data, jpeg.size, bgr.data, width, static_cast<int>(bgr.step),
                                   height, TJPF_BGR, TJFLAG_STOPONWARNING);
  require(failed == 0, "JPEG of {} bytes is damaged: {}", jpeg.size, tjGetErrorStr2(handle.get()));
  return bgr;
}

std::vector<std::uint8_t> zip_depth(const cv::Mat& depth_mm, int level) {
  require(level >= 1 && level <= 9, "zlib level {}, expected 1 to 9", level);
  require(depth_mm.type() == CV_16UC1 && depth_mm.isContinuous(), "depth image of OpenCV type {}, expected 16-bit",
          depth_mm.type());
  const std::unique_ptr<libdeflate_compressor, ZipDeleter> zip(libdeflate_alloc_compressor(level));
  const std::size_t raw_size = depth_mm.total() * depth_mm.elemSize();
  std::vector<std::uint8_t> zipped(libdeflate_zlib_compress_bound(zip.get(), raw_size));
  zipped.resize(libdeflate_zlib_compress(zip.get(), depth_mm.data, raw_size, zipped.data(), zipped.size()));
  require(!zipped.empty(), "depth of {} bytes could not be compressed", raw_size);
  return zipped;
}

std::vector<std::uint8_t> unzip(ByteView zipped, std::size_t raw_size) {
  require(zipped.size >= raw_size / kMaxDeflateRatio, "zlib data of {} bytes, too few for {} bytes", zipped.size,
          raw_size);
  std::vector<std::uint8_t> raw(raw_size);
  unzip_into(zipped, raw.data(), raw_size);
  return raw;
}

cv::Mat unzip_depth(ByteView zipped, int width, int height) {
  check_image_size(width, height);
  const std::size_t raw_size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 2;
  require(zipped.size >= raw_size / kMaxDeflateRatio, "zlib data of {} bytes, too few for depth of {}x{} pixels",
          zipped.size, width, height);
  cv::Mat depth_mm(height, width, CV_16UC1);
  unzip_into(zipped, depth_mm.data, raw_size);
  return depth_mm;
}

}  // namespace houghstream
