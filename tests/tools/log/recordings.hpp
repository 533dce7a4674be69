#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <houghstream/drake_image_array_t.hpp>
#include <houghstream/kinect_frame_msg_t.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/codecs.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tests/pipeline/test_frame.hpp"

// Recordings as other programs make them, of make_test_frame().

namespace houghstream::log_tools {

/// Returns a frame that differs from its neighbours, 64x48.
inline RgbdFrame numbered_frame(int index) {
  RgbdFrame frame = make_test_frame(1'500'000'000'000'000 + 33'000 * index);
  frame.colour.at<cv::Vec3b>(7, 9) = cv::Vec3b(static_cast<uchar>(index), 1, 2);
  frame.depth.at<float>(20, 30) = static_cast<float>(500 + index) * 1e-3F;
  return frame;
}

inline std::vector<std::uint8_t> bytes_of_mat(const cv::Mat& mat) {
  return {mat.data, mat.data + mat.total() * mat.elemSize()};
}

inline std::vector<std::uint8_t> rgb_bytes(const RgbdFrame& frame) {
  cv::Mat rgb;
  cv::cvtColor(frame.colour, rgb, cv::COLOR_BGR2RGB);
  return bytes_of_mat(rgb);
}

inline kinect_frame_msg_t kinect_message(const RgbdFrame& frame, bool compressed) {
  kinect_frame_msg_t message{};
  message.timestamp = frame.id.utime;
  message.image.width = static_cast<std::int16_t>(frame.colour.cols);
  message.image.height = static_cast<std::int16_t>(frame.colour.rows);
  message.image.image_data = compressed ? encode_jpeg(frame.colour, 90) : rgb_bytes(frame);
  message.image.image_data_nbytes = static_cast<std::int32_t>(message.image.image_data.size());
  message.image.image_data_format = kinect_image_msg_t::VIDEO_RGB;
  if (compressed) message.image.image_data_format = kinect_image_msg_t::VIDEO_RGB_JPEG;
  const cv::Mat depth_mm = depth_to_millimetres(frame.depth);
  message.depth.width = message.image.width;
  message.depth.height = message.image.height;
  message.depth.depth_data = compressed ? zip_depth(depth_mm, 1) : bytes_of_mat(depth_mm);
  message.depth.depth_data_nbytes = static_cast<std::int32_t>(message.depth.depth_data.size());
  message.depth.depth_data_format = kinect_depth_msg_t::DEPTH_MM;
  message.depth.compression = kinect_depth_msg_t::COMPRESSION_NONE;
  if (compressed) message.depth.compression = kinect_depth_msg_t::COMPRESSION_ZLIB;
  return message;
}

inline drake_image_t drake_image(const cv::Mat& pixels, std::int8_t format, std::int8_t channel_type) {
  drake_image_t image{};
  image.header.frame_name = "camera";
  image.width = pixels.cols;
  image.height = pixels.rows;
  image.row_stride = static_cast<std::int32_t>(pixels.cols * pixels.elemSize());
  image.data = bytes_of_mat(pixels);
  image.size = static_cast<std::int32_t>(image.data.size());
  image.pixel_format = format;
  image.channel_type = channel_type;
  return image;
}

/// Raw colour (BGR) and depth in metres, and a label image that is to be passed over.
inline drake_image_array_t drake_message(const RgbdFrame& frame) {
  constexpr std::int8_t kLabel = 6;
  drake_image_array_t message{};
  message.header.utime = frame.id.utime;
  message.images.push_back(drake_image(cv::Mat(5, 4, CV_16UC1, cv::Scalar(3)), kLabel, 2));
  message.images.push_back(
      drake_image(frame.colour, drake_image_t::PIXEL_FORMAT_BGR, drake_image_t::CHANNEL_TYPE_UINT8));
  message.images.push_back(
      drake_image(frame.depth, drake_image_t::PIXEL_FORMAT_DEPTH, drake_image_t::CHANNEL_TYPE_FLOAT32));
  message.num_images = 3;
  return message;
}

/// Appends numbers and bytes as they lie in the memory of a little-endian machine.
class KlgWriter {
 public:
  explicit KlgWriter(std::int32_t frames) { put(frames); }

  void add(const RgbdFrame& frame, bool compressed) {
    const cv::Mat depth_mm = depth_to_millimetres(frame.depth);
    const std::vector<std::uint8_t> depth = compressed ? zip_depth(depth_mm, 1) : bytes_of_mat(depth_mm);
    const std::vector<std::uint8_t> colour = compressed ? encode_jpeg(frame.colour, 90) : rgb_bytes(frame);
    put(frame.id.utime);
    put(static_cast<std::int32_t>(depth.size()));
    put(static_cast<std::int32_t>(colour.size()));
    bytes_.insert(bytes_.end(), depth.begin(), depth.end());
    bytes_.insert(bytes_.end(), colour.begin(), colour.end());
  }

  void save(const std::filesystem::path& file) const {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes_.data()), static_cast<std::streamsize>(bytes_.size()));
  }

 private:
  template <typename Number>
  void put(Number number) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof(number));
    std::memcpy(bytes_.data() + at, &number, sizeof(number));
  }

  std::vector<std::uint8_t> bytes_;
};

/// Writes a log with one message after another, 33 ms apart.
class TestLog {
 public:
  explicit TestLog(const std::filesystem::path& file) : log_(file) {}

  template <typename Message>
  void add(const std::string& channel, const Message& message) {
    add_bytes(channel, encode_message(message));
  }
  void add_bytes(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    log_.write(1'500'000'000'000'000 + 33'000 * events_++, channel, {bytes.data(), bytes.size()});
  }
  void close() { log_.close(); }

 private:
  LogWriter log_;
  std::int64_t events_ = 0;
};

/// images_t as a bot_core driver sends it: raw colour, no metadata.
inline images_t foreign_images(const RgbdFrame& frame) {
  WireFormat raw;
  raw.jpeg = false;
  images_t message = to_message(frame, raw, 0);
  message.images[0].metadata.clear();
  message.images[0].nmetadata = 0;
  return message;
}

/// A log with the first frames as messages on the channel, and after each of them one that is none on another channel.
template <typename Message>
std::string log_of(const std::filesystem::path& folder, int frames, const std::string& channel,
                   Message (*make)(const RgbdFrame&)) {
  const std::filesystem::path file = folder / "original.lcmlog";
  TestLog log(file);
  for (int i = 0; i < frames; ++i) {
    log.add(channel, make(numbered_frame(i)));
    log.add_bytes("OTHER", {1, 2, 3});
  }
  log.close();
  return file.string();
}

}  // namespace houghstream::log_tools
