#include "drivers/files/image_file.hpp"

#include <opencv2/imgcodecs.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/image_decoding.hpp"

namespace houghstream {
namespace {

cv::Mat read_image(const std::filesystem::path& file, int mode) {
  require_regular_file(file, "an image");
  cv::Mat image = decode_image_file(file, mode);
  require(!image.empty(), "{}: cannot be decoded, expected an image", file.string());
  return image;
}

}  // namespace

cv::Mat read_colour_image(const std::filesystem::path& file) {
  return read_image(file, cv::IMREAD_COLOR);
}

cv::Mat read_depth_image(const std::filesystem::path& file) {
  cv::Mat depth = read_image(file, cv::IMREAD_UNCHANGED);
  require(depth.type() == CV_16UC1, "{}: {} channels of {} bytes, expected one channel of 16 bits", file.string(),
          depth.channels(), depth.elemSize1());
  return depth;
}

cv::Mat read_mask_image(const std::filesystem::path& file) {
  return read_image(file, cv::IMREAD_GRAYSCALE) > 0;
}

void write_png(const cv::Mat& image, const std::filesystem::path& file) {
  // Level 1 writes several times faster than the default and costs about a tenth in size.
  constexpr int kCompression = 1;
  write_image(image, file, {cv::IMWRITE_PNG_COMPRESSION, kCompression});
}

void require_image_format(const std::filesystem::path& file) {
  require(cv::haveImageWriter(file.extension().string()),
          "{}: not a picture format that can be written, expected .png or .jpg", file.string());
}

void write_image(const cv::Mat& image, const std::filesystem::path& file, const std::vector<int>& settings) {
  require_image_format(file);
  std::vector<unsigned char> bytes;
  bool encoded = false;
  try {
    encoded = cv::imencode(file.extension().string(), image, bytes, settings);
  } catch (const cv::Exception&) {
    encoded = false;  // a type of image that the format does not know
  }
  require(encoded, "{}: cannot be written in this format, expected .png or .jpg", file.string());
  write_file_atomically(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace houghstream
