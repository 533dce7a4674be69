#pragma once

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "drivers/ros_bag/ros_messages.hpp"
#include "pipeline/types/camera.hpp"

// ROS 1 bags and messages, written byte by byte from their published description (wiki.ros.org/Bags/Format/2.0).

namespace houghstream::ros_bag {

using Bytes = std::vector<std::uint8_t>;

template <typename Number>
void append(Bytes& bytes, Number number) {
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(&number);
  bytes.insert(bytes.end(), begin, begin + sizeof number);
}

inline void append_all(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

inline void append_sized(Bytes& bytes, const Bytes& more) {
  append(bytes, static_cast<std::uint32_t>(more.size()));
  append_all(bytes, more);
}

inline void append_text(Bytes& bytes, const std::string& text) {
  append_sized(bytes, {text.begin(), text.end()});
}

/// Appends a field NAME=VALUE of a record's header.
template <typename Value>
void append_field(Bytes& bytes, const std::string& name, const Value& value) {
  Bytes field(name.begin(), name.end());
  field.push_back('=');
  if constexpr (std::is_same_v<Value, std::string>) {
    field.insert(field.end(), value.begin(), value.end());
  } else {
    append(field, value);
  }
  append_sized(bytes, field);
}

/// Returns seconds and nanoseconds as a bag's time.
inline std::uint64_t bag_time(std::int64_t ns) {
  return static_cast<std::uint64_t>(ns / 1'000'000'000) | static_cast<std::uint64_t>(ns % 1'000'000'000) << 32U;
}

inline Bytes compressed_chunk(const Bytes& records, const std::string& compression) {
  if (compression == "bz2") {
    Bytes out(records.size() + records.size() / 50 + 700);
    auto size = static_cast<unsigned>(out.size());
    BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(out.data()), &size,
                             const_cast<char*>(reinterpret_cast<const char*>(records.data())),
                             static_cast<unsigned>(records.size()), 9, 0, 0);
    out.resize(size);
    return out;
  }
  if (compression == "lz4") {
    LZ4F_preferences_t preferences{};
    preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;  // as ROS's library has it
    Bytes out(LZ4F_compressFrameBound(records.size(), &preferences));
    out.resize(LZ4F_compressFrame(out.data(), out.size(), records.data(), records.size(), &preferences));
    return out;
  }
  return records;
}

/// Writes a bag. Chunks are closed by end_chunk(), or hold all.
class TestBag {
 public:
  explicit TestBag(std::string compression = "none") : compression_(std::move(compression)) {}

  /// Adds a message received at this time, which is that of its stamp unless given.
  void add(const std::string& topic, const std::string& type, const Bytes& message, std::int64_t received_us) {
    const auto [connection, is_new] = connections_.emplace(topic, static_cast<std::uint32_t>(connections_.size()));
    if (is_new) {
      types_[topic] = type;
      append_connection(chunk_, topic);
    }
    Bytes header;
    append_field(header, "op", std::uint8_t{2});
    append_field(header, "conn", connection->second);
    append_field(header, "time", bag_time(received_us * 1000));
    append_sized(chunk_, header);
    append_sized(chunk_, message);
    const std::uint64_t time = bag_time(received_us * 1000);
    index_[connection->second].emplace_back(time, 0U);
    times_us_.push_back(received_us);
  }

  void end_chunk() {
    if (times_us_.empty()) return;
    Bytes info;
    append_field(info, "op", std::uint8_t{6});
    append_field(info, "ver", std::uint32_t{1});
    append_field(info, "chunk_pos", static_cast<std::uint64_t>(body_.size() + kBegin));
    append_field(info, "start_time", bag_time(1000 * *std::min_element(times_us_.begin(), times_us_.end())));
    append_field(info, "end_time", bag_time(1000 * *std::max_element(times_us_.begin(), times_us_.end())));
    append_field(info, "count", static_cast<std::uint32_t>(index_.size()));
    append_sized(infos_, info);
    Bytes counts;
    Bytes header;
    append_field(header, "op", std::uint8_t{5});
    append_field(header, "compression", compression_);
    append_field(header, "size", static_cast<std::uint32_t>(chunk_.size()));
    append_sized(body_, header);
    append_sized(body_, compressed_chunk(chunk_, compression_));
    for (const auto& [connection, entries] : index_) {
      append(counts, connection);
      append(counts, static_cast<std::uint32_t>(entries.size()));
      append_index(connection, entries);
    }
    append_sized(infos_, counts);
    ++chunks_;
    chunk_.clear();
    index_.clear();
    times_us_.clear();
  }

  /// Returns the bag's bytes; without an index as a recorder leaves it that was killed.
  Bytes bytes(bool is_indexed = true) {
    end_chunk();
    Bytes header;
    append_field(header, "op", std::uint8_t{3});
    append_field(header, "index_pos", static_cast<std::uint64_t>(is_indexed ? body_.size() + kBegin : 0));
    append_field(header, "conn_count", static_cast<std::uint32_t>(is_indexed ? connections_.size() : 0));
    append_field(header, "chunk_count", is_indexed ? chunks_ : 0U);
    const std::string version = "#ROSBAG V2.0\n";
    Bytes out(version.begin(), version.end());
    append_sized(out, header);
    append_sized(out, Bytes(kBegin - out.size() - sizeof(std::uint32_t), ' '));
    append_all(out, body_);
    if (!is_indexed) return out;
    std::map<std::uint32_t, std::string> topics;
    for (const auto& [topic, connection] : connections_) topics[connection] = topic;
    for (const auto& [connection, topic] : topics) append_connection(out, topic);
    append_all(out, infos_);
    return out;
  }

  void save(const std::string& file) {
    const Bytes all = bytes();
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(all.data()), static_cast<std::streamsize>(all.size()));
  }

 private:
  static constexpr std::size_t kBegin = 4117;  // behind the version and the padded header

  void append_connection(Bytes& bytes, const std::string& topic) {
    Bytes header;
    append_field(header, "op", std::uint8_t{7});
    append_field(header, "conn", connections_.at(topic));
    append_field(header, "topic", topic);
    append_sized(bytes, header);
    Bytes data;
    append_field(data, "topic", topic);
    append_field(data, "type", types_.at(topic));
    append_field(data, "md5sum", std::string(32, '0'));
    append_field(data, "message_definition", std::string("# none"));
    append_sized(bytes, data);
  }

  void append_index(std::uint32_t connection, const std::vector<std::pair<std::uint64_t, std::uint32_t>>& entries) {
    Bytes header;
    append_field(header, "op", std::uint8_t{4});
    append_field(header, "ver", std::uint32_t{1});
    append_field(header, "conn", connection);
    append_field(header, "count", static_cast<std::uint32_t>(entries.size()));
    append_sized(body_, header);
    Bytes data;
    for (const auto& [time, offset] : entries) {
      append(data, time);
      append(data, offset);
    }
    append_sized(body_, data);
  }

  std::string compression_;
  std::map<std::string, std::uint32_t> connections_;
  std::map<std::string, std::string> types_;
  Bytes chunk_;
  std::map<std::uint32_t, std::vector<std::pair<std::uint64_t, std::uint32_t>>> index_;  // of the chunk
  std::vector<std::int64_t> times_us_;                                                   // of the chunk
  Bytes body_;
  Bytes infos_;
  std::uint32_t chunks_ = 0;
};

inline Bytes header_bytes(const MessageHeader& header) {
  Bytes bytes;
  append(bytes, std::uint32_t{7});
  append(bytes, static_cast<std::uint32_t>(header.stamp_us / 1'000'000));
  append(bytes, static_cast<std::uint32_t>(header.stamp_us % 1'000'000 * 1000));
  append_text(bytes, header.frame_id);
  return bytes;
}

/// Returns a sensor_msgs/Image whose rows are `padding` bytes longer than their pixels.
inline Bytes image_bytes(const MessageHeader& header, const cv::Mat& pixels, const std::string& encoding,
                         std::size_t padding = 0, bool is_big_endian = false) {
  Bytes bytes = header_bytes(header);
  append(bytes, static_cast<std::uint32_t>(pixels.rows));
  append(bytes, static_cast<std::uint32_t>(pixels.cols));
  append_text(bytes, encoding);
  append(bytes, static_cast<std::uint8_t>(is_big_endian));
  const std::size_t row = pixels.cols * pixels.elemSize();
  append(bytes, static_cast<std::uint32_t>(row + padding));
  Bytes data;
  for (int y = 0; y < pixels.rows; ++y) {
    data.insert(data.end(), pixels.ptr(y), pixels.ptr(y) + row);
    if (is_big_endian) {
      for (std::size_t x = data.size() - row; x < data.size(); x += pixels.elemSize())
        std::reverse(data.begin() + static_cast<std::ptrdiff_t>(x),
                     data.begin() + static_cast<std::ptrdiff_t>(x + pixels.elemSize()));
    }
    data.insert(data.end(), padding, 0xEE);
  }
  append_sized(bytes, data);
  return bytes;
}

/// Returns a sensor_msgs/CompressedImage.
inline Bytes compressed_image_bytes(const MessageHeader& header, const std::string& format, const Bytes& data) {
  Bytes bytes = header_bytes(header);
  append_text(bytes, format);
  append_sized(bytes, data);
  return bytes;
}

inline Bytes png_of(const cv::Mat& image) {
  Bytes png;
  cv::imencode(".png", image, png);
  return png;
}

/// Returns a sensor_msgs/CameraInfo of the whole sensor.
inline Bytes camera_info_bytes(const MessageHeader& header, const Camera& camera, double distortion = 0.0,
                               const std::array<std::uint32_t, 6>& binning_and_roi = {}) {
  Bytes bytes = header_bytes(header);
  append(bytes, static_cast<std::uint32_t>(camera.height));
  append(bytes, static_cast<std::uint32_t>(camera.width));
  append_text(bytes, "plumb_bob");
  append(bytes, std::uint32_t{5});
  for (const double coefficient : {distortion, 0.0, 0.0, 0.0, 0.0}) append(bytes, coefficient);
  for (const double k : {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0}) append(bytes, k);
  for (const double r : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) append(bytes, r);
  for (const double p :
       {camera.fx + 1.0, 0.0, camera.cx, 0.0, 0.0, camera.fy + 1.0, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0})
    append(bytes, p);
  for (const std::uint32_t number : binning_and_roi) append(bytes, number);  // binning x, y; roi x, y, height, width
  append(bytes, std::uint8_t{0});
  return bytes;
}

}  // namespace houghstream::ros_bag
