#include "tools/log/klg_file.hpp"

#include <cstring>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/messages/codecs.hpp"
#include "tools/log/third_party_frames.hpp"

namespace houghstream::log_tools {
namespace {

template <typename Number>
Number little_endian(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers are copied as they lie in the file");
  Number number{};
  std::memcpy(&number, bytes.data() + at, sizeof(number));
  return number;
}

}  // namespace

KlgFile::KlgFile(const std::filesystem::path& file, int width, int height)
    : file_(file.string()), width_(width), height_(height) {
  check_image_size(width, height);
  require_regular_file(file, "a .klg file");
  in_.open(file, std::ios::binary);
  std::error_code error;
  size_ = std::filesystem::file_size(file, error);
  require(in_.good() && !error, "{}: cannot be read, expected a .klg file", file_);
  frames_ = little_endian<std::int32_t>(read(4, "the number of frames"), 0);
  require(frames_ >= 0, "{}: {} frames, expected 0 or more; is it a .klg file?", file_, frames_);
  position_ = 4;
}

std::vector<std::uint8_t> KlgFile::read(std::uint64_t bytes, const char* what) {
  const auto at = static_cast<std::uint64_t>(in_.tellg());
  require(bytes <= size_ - at, "{}: cut in frame {}: {} bytes are left for {} of {}", file_, index_, size_ - at, what,
          bytes);
  std::vector<std::uint8_t> data(bytes);
  in_.read(reinterpret_cast<char*>(data.data()), static_cast<std::streamsize>(bytes));
  require(in_.good(), "{}: frame {} cannot be read", file_, index_);
  return data;
}

std::optional<images_t> KlgFile::next() {
  if (index_ == frames_) {
    require(bytes_left() == 0, "{}: states {} frames, but {} bytes lie behind them: is it damaged, or was not ended?",
            file_, frames_, bytes_left());
    return std::nullopt;
  }
  const std::vector<std::uint8_t> head = read(16, "a frame's head");
  const auto utime = little_endian<std::int64_t>(head, 0);
  const auto depth_bytes = little_endian<std::int32_t>(head, 8);
  const auto colour_bytes = little_endian<std::int32_t>(head, 12);
  require(depth_bytes > 0 && colour_bytes > 0, "{}: frame {} states {} bytes of depth and {} of colour, expected both",
          file_, index_, depth_bytes, colour_bytes);
  std::vector<std::uint8_t> depth = read(static_cast<std::uint64_t>(depth_bytes), "depth");
  std::vector<std::uint8_t> colour = read(static_cast<std::uint64_t>(colour_bytes), "colour");
  position_ = static_cast<std::uint64_t>(in_.tellg());
  ++index_;
  const bool raw_depth = depth_bytes == 2 * width_ * height_;
  const bool raw_colour = colour_bytes == 3 * width_ * height_;
  std::int32_t colour_format = image_t::PIXEL_FORMAT_MJPEG;
  if (raw_colour) colour_format = image_t::PIXEL_FORMAT_RGB;
  std::int16_t depth_type = images_t::DEPTH_MM_ZIPPED;
  if (raw_depth) depth_type = images_t::DEPTH_MM;
  image_t colour_image = make_image(width_, height_, colour_format, raw_colour ? 3 * width_ : 0, std::move(colour));
  image_t depth_image =
      make_image(width_, height_, image_t::PIXEL_FORMAT_LE_GRAY16, raw_depth ? 2 * width_ : 0, std::move(depth));
  return make_images(utime, std::move(colour_image), depth_type, std::move(depth_image));
}

}  // namespace houghstream::log_tools
