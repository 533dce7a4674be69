#include "pipeline/base/image_decoding.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace houghstream {
namespace {

constexpr std::uint64_t kMaxPixels = 64'000'000;
constexpr int kMaxScans = 64;
constexpr std::uint8_t kScan = 0xDA;  // a JPEG's marker
constexpr std::array<std::uint8_t, 8> kPngStart = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kPngHeader = 24;  // up to the height

std::uint64_t big_endian(const std::uint8_t* bytes, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8U | bytes[i];
  return value;
}

bool is_jpeg(const std::uint8_t* bytes, std::size_t size) {
  return size >= 2 && bytes[0] == 0xFF && bytes[1] == 0xD8;
}

/// Calls `visit` with each marker of a JPEG and where the bytes behind it begin.
template <typename Visit>
void walk_jpeg(const std::uint8_t* jpeg, std::size_t size, const Visit& visit) {
  std::size_t at = 2;  // behind the start of the image
  while (at + 4 <= size) {
    // Nearly all bytes are a scan's, of which few are 0xFF.
    const void* next = std::memchr(jpeg + at, 0xFF, size - at);
    if (next == nullptr) return;
    at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(next) - jpeg);
    if (at + 4 > size) return;
    const std::uint8_t marker = jpeg[at + 1];
    if (marker == 0 || marker == 0xFF) {  // a byte of a scan, or a fill byte
      ++at;
      continue;
    }
    constexpr std::uint8_t kEnd = 0xD9;
    if (marker == kEnd) return;
    constexpr std::uint8_t kTemporary = 0x01;
    const bool is_alone = marker == kTemporary || (marker >= 0xD0 && marker <= 0xD7);  // has no length field
    visit(marker, at + 2);
    at += is_alone ? 2 : 2 + static_cast<std::size_t>(big_endian(jpeg + at + 2, 2));
  }
}

/// Returns the pixels of its largest frame; 0 where it has none.
std::uint64_t jpeg_pixels(const std::uint8_t* jpeg, std::size_t size) {
  std::uint64_t maximum = 0;
  walk_jpeg(jpeg, size, [&](std::uint8_t marker, std::size_t at) {
    const bool is_frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame && at + 7 <= size)
      maximum = std::max(maximum, big_endian(jpeg + at + 3, 2) * big_endian(jpeg + at + 5, 2));
  });
  return maximum;
}

/// Returns whether a marker ends the last scan; a decoder would fill up a truncated scan.
bool has_jpeg_end(const std::uint8_t* jpeg, std::size_t size) {
  constexpr std::array<std::uint8_t, 2> kEnd = {0xFF, 0xD9};
  std::size_t scan = size;
  walk_jpeg(jpeg, size, [&](std::uint8_t marker, std::size_t at) { scan = marker == kScan ? at : scan; });
  return std::search(jpeg + scan, jpeg + size, kEnd.begin(), kEnd.end()) != jpeg + size;
}

bool is_png(const std::uint8_t* bytes, std::size_t size) {
  return size >= kPngHeader && std::equal(kPngStart.begin(), kPngStart.end(), bytes);
}

/// Returns whether a PNG file reaches its last chunk; of a file that is cut libpng would tell in a line of its own.
bool has_png_end(const std::filesystem::path& file) {
  constexpr std::streamoff kChecksum = 4;
  std::ifstream in(file, std::ios::binary);
  in.seekg(kPngStart.size());
  std::array<std::uint8_t, 8> head{};  // length and type of a chunk
  while (in.read(reinterpret_cast<char*>(head.data()), head.size())) {
    if (std::memcmp(head.data() + 4, "IEND", 4) == 0) return true;
    in.seekg(static_cast<std::streamoff>(big_endian(head.data(), 4)) + kChecksum, std::ios::cur);
  }
  return false;
}

/// Other formats are left to OpenCV.
bool is_modest(const std::uint8_t* bytes, std::size_t size) {
  if (is_jpeg(bytes, size)) return jpeg_pixels(bytes, size) <= kMaxPixels && count_jpeg_scans(bytes, size) <= kMaxScans;
  if (!is_png(bytes, size)) return true;
  const std::uint64_t width = big_endian(bytes + 16, 4);
  const std::uint64_t height = big_endian(bytes + 20, 4);
  return width * height <= kMaxPixels;
}

/// A JPEG is read whole, other files as far as their header may reach.
std::vector<std::uint8_t> bytes_to_judge(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<std::uint8_t> bytes(kPngHeader);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  if (is_jpeg(bytes.data(), bytes.size()))
    bytes.insert(bytes.end(), std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  return bytes;
}

}  // namespace

cv::Mat decode_image(const std::uint8_t* bytes, std::size_t size, int mode) {
  if (size == 0 || size > static_cast<std::size_t>(std::numeric_limits<int>::max()) || !is_modest(bytes, size))
    return {};
  try {
    // The matrix borrows the bytes, and is read only.
    return cv::imdecode(cv::Mat(1, static_cast<int>(size), CV_8UC1, const_cast<std::uint8_t*>(bytes)), mode);
  } catch (const cv::Exception&) {
    return {};
  }
}

cv::Mat decode_image_file(const std::filesystem::path& file, int mode) {
  const std::vector<std::uint8_t> bytes = bytes_to_judge(file);
  if (is_jpeg(bytes.data(), bytes.size())) {  // all of it is here
    return has_jpeg_end(bytes.data(), bytes.size()) ? decode_image(bytes.data(), bytes.size(), mode) : cv::Mat();
  }
  if (!is_modest(bytes.data(), bytes.size())) return {};
  if (is_png(bytes.data(), bytes.size()) && !has_png_end(file)) return {};
  try {
    return cv::imread(file.string(), mode);
  } catch (const cv::Exception&) {
    return {};
  }
}

int count_jpeg_scans(const std::uint8_t* jpeg, std::size_t size) {
  int scans = 0;
  walk_jpeg(jpeg, size, [&](std::uint8_t marker, std::size_t /*at*/) { scans += marker == kScan ? 1 : 0; });
  return scans;
}

}  // namespace houghstream
