#include "drivers/ros_bag/bag_images.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "pipeline/base/image_decoding.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/no_value.hpp"
#include "pipeline/base/printable.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream::ros_bag {
namespace {

constexpr const char* kCompressedDepth = "compressedDepth";

/// Describes the pixels of an encoding.
struct PixelFormat {
  const char* encoding;
  int type;
  ImageKind kind;
  int to_bgr;  // OpenCV's code of the conversion; -1: the pixels are BGR, or depth
};
constexpr PixelFormat kPixelFormats[] = {
    {"16UC1", CV_16UC1, ImageKind::kDepth, -1},
    {"mono16", CV_16UC1, ImageKind::kDepth, -1},
    {"32FC1", CV_32FC1, ImageKind::kDepth, -1},
    {"rgb8", CV_8UC3, ImageKind::kColour, cv::COLOR_RGB2BGR},
    {"bgr8", CV_8UC3, ImageKind::kColour, -1},
    {"rgba8", CV_8UC4, ImageKind::kColour, cv::COLOR_RGBA2BGR},
    {"bgra8", CV_8UC4, ImageKind::kColour, cv::COLOR_BGRA2BGR},
    {"mono8", CV_8UC1, ImageKind::kGrey, cv::COLOR_GRAY2BGR},
};

const PixelFormat* find_format(const std::string& encoding) {
  const auto* const found = std::find_if(std::begin(kPixelFormats), std::end(kPixelFormats),
                                         [&](const PixelFormat& format) { return encoding == format.encoding; });
  return found == std::end(kPixelFormats) ? nullptr : found;
}

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

/// Returns the encoding of the image that was encoded: "16UC1" of "16UC1; compressedDepth png".
std::string original_encoding(const ImageMessage& image) {
  const std::size_t end = image.encoding.find(';');
  return end == std::string::npos ? "" : image.encoding.substr(0, end);
}

bool is_depth_encoding(const std::string& encoding) {
  const PixelFormat* const format = find_format(encoding);
  return format != nullptr && format->kind == ImageKind::kDepth;
}

/// Refers to the pixels of a raw image where they lie.
cv::Mat pixels_of(const ImageMessage& image, int type, const std::string& source) {
  constexpr std::uint32_t kMaxSize = 16384;
  require(image.width >= 1 && image.width <= kMaxSize && image.height >= 1 && image.height <= kMaxSize,
          "{}: {}x{} pixels, expected 1 to {} each", source, image.width, image.height, kMaxSize);
  const std::size_t needed = image.width * CV_ELEM_SIZE(type);
  require(image.row_bytes >= needed, "{}: rows of {} bytes, expected at least {} for {} pixels of {}", source,
          image.row_bytes, needed, image.width, image.encoding);
  const std::size_t size = std::size_t{image.row_bytes} * image.height;
  require(image.data.size == size, "{}: {} bytes of pixels, expected {} rows of {}", source, image.data.size,
          image.height, image.row_bytes);
  // OpenCV refers to mutable pixels only; these are copied before anything changes them.
  return {static_cast<int>(image.height), static_cast<int>(image.width), type,
          const_cast<std::uint8_t*>(image.data.data), image.row_bytes};
}

cv::Mat swap_bytes(const cv::Mat& pixels) {
  cv::Mat swapped = pixels.clone();
  const std::size_t size = swapped.elemSize();
  for (std::uint8_t* pixel = swapped.data; pixel != swapped.dataend; pixel += size) std::reverse(pixel, pixel + size);
  return swapped;
}

cv::Mat decode_encoded(ByteRange bytes, int mode, const std::string& source) {
  cv::Mat image;
  try {
    image = decode_image(bytes.data, bytes.size, mode);
  } catch (const cv::Exception&) {
    image.release();  // OpenCV's words name no source
  }
  require(!image.empty(), "{}: {} bytes that cannot be decoded, expected a JPEG or PNG", source, bytes.size);
  return image;
}

cv::Mat without_invalid(const cv::Mat& metres) {
  cv::Mat depth(metres.size(), CV_32FC1);
  for (int y = 0; y < depth.rows; ++y) {
    const auto* in = metres.ptr<float>(y);
    auto* out = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) out[x] = std::isfinite(in[x]) && in[x] > 0.0F ? in[x] : kNoValue;
  }
  return depth;
}

/// Returns the depth of a quantised inverse, 1/z = (value - b) / a; 0 = none.
cv::Mat depth_of_inverse(const cv::Mat& quantised, float a, float b) {
  cv::Mat metres(quantised.size(), CV_32FC1);
  for (int y = 0; y < metres.rows; ++y) {
    const auto* in = quantised.ptr<std::uint16_t>(y);
    auto* out = metres.ptr<float>(y);
    for (int x = 0; x < metres.cols; ++x) out[x] = in[x] == 0 ? kNoValue : a / (static_cast<float>(in[x]) - b);
  }
  return without_invalid(metres);
}

cv::Mat decode_encoded_depth(const ImageMessage& image, const std::string& source) {
  ByteRange png = image.data;
  std::array<float, 2> quantisation{};
  if (contains(image.encoding, kCompressedDepth)) {
    require(!contains(image.encoding, "rvl"), "{}: format '{}', expected PNG", source, printable(image.encoding));
    ByteReader reader(image.data, source);
    reader.read<std::uint32_t>();  // the header's kind, of which there is one
    for (float& parameter : quantisation) parameter = reader.read<float>();
    png = reader.read_bytes(reader.left());
  }
  const cv::Mat values = decode_encoded(png, cv::IMREAD_UNCHANGED, source);
  require(values.type() == CV_16UC1, "{}: a PNG of {} channels of {} bytes, expected one channel of 16 bits", source,
          values.channels(), values.elemSize1());
  if (original_encoding(image) == "32FC1") return depth_of_inverse(values, quantisation[0], quantisation[1]);
  return depth_from_millimetres(values);
}

}  // namespace

ImageKind kind_of_image(const ImageMessage& image) {
  if (!image.is_encoded) {
    const PixelFormat* const format = find_format(image.encoding);
    return format == nullptr ? ImageKind::kOther : format->kind;
  }
  if (contains(image.encoding, kCompressedDepth)) return ImageKind::kDepth;
  if (is_depth_encoding(original_encoding(image)))
    return contains(image.encoding, "png") ? ImageKind::kDepth : ImageKind::kOther;
  const std::string format = image.encoding;
  if (!contains(format, "jpeg") && !contains(format, "jpg") && !contains(format, "png")) return ImageKind::kOther;
  return original_encoding(image) == "mono8" ? ImageKind::kGrey : ImageKind::kColour;
}

cv::Mat decode_colour(const ImageMessage& image, const std::string& source) {
  const ImageKind kind = kind_of_image(image);
  require(kind == ImageKind::kColour || kind == ImageKind::kGrey,
          "{}: encoding '{}', expected rgb8, bgr8, rgba8, bgra8, mono8, JPEG or PNG", source,
          printable(image.encoding));
  if (image.is_encoded) return decode_encoded(image.data, cv::IMREAD_COLOR, source);
  const PixelFormat& format = *find_format(image.encoding);
  const cv::Mat pixels = pixels_of(image, format.type, source);
  if (format.to_bgr < 0) return pixels.clone();
  cv::Mat colour;
  cv::cvtColor(pixels, colour, format.to_bgr);
  return colour;
}

cv::Mat decode_depth(const ImageMessage& image, const std::string& source) {
  require(kind_of_image(image) == ImageKind::kDepth,
          "{}: encoding '{}', expected 16UC1, mono16, 32FC1 or compressedDepth", source, printable(image.encoding));
  if (image.is_encoded) return decode_encoded_depth(image, source);
  const cv::Mat raw = pixels_of(image, find_format(image.encoding)->type, source);
  // In a message they begin at any byte; numbers are read where they are aligned.
  const cv::Mat pixels = image.is_big_endian ? swap_bytes(raw) : raw.clone();
  return pixels.type() == CV_16UC1 ? depth_from_millimetres(pixels) : without_invalid(pixels);
}

Camera camera_of_info(const CameraInfoMessage& info, bool is_rectified, const std::string& source) {
  const auto int_of = [&](std::uint32_t pixels) {
    require(pixels <= 1'000'000, "{}: {} pixels, expected an image", source, pixels);
    return static_cast<int>(pixels);
  };
  Camera camera;
  camera.width = int_of(info.width);
  camera.height = int_of(info.height);
  const bool by_projection = is_rectified && info.projection[0] != 0.0;
  camera.fx = by_projection ? info.projection[0] : info.intrinsics[0];
  camera.fy = by_projection ? info.projection[5] : info.intrinsics[4];
  camera.cx = by_projection ? info.projection[2] : info.intrinsics[2];
  camera.cy = by_projection ? info.projection[6] : info.intrinsics[5];
  check_camera(camera, source);
  if (info.roi_width > 0 && info.roi_height > 0) {
    camera = camera.cropped(int_of(info.roi_x), int_of(info.roi_y), int_of(info.roi_width), int_of(info.roi_height));
  }
  const int binning = std::max(1, int_of(info.binning_x));
  require(binning == std::max(1, int_of(info.binning_y)), "{}: binning of {}x{}, expected as many rows as columns",
          source, info.binning_x, info.binning_y);
  if (binning > 1) camera = camera.scaled(1.0 / binning);
  check_camera(camera, source);
  const bool is_distorted = std::any_of(info.distortion.begin(), info.distortion.end(),
                                        [](double coefficient) { return std::abs(coefficient) >= 1e-9; });
  if (is_distorted && !is_rectified)
    log_warning("{}: its distortion is not corrected; boxes and poses near the image's edge may be a little off",
                source);
  return camera;
}

}  // namespace houghstream::ros_bag
