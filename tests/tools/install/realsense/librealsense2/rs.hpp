#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// This file replaces RealSense's SDK by the part of its interface that the example uses, with the SDK's own names.
// Colour is 64x48, red, in RGB where it comes from a file; depth counts in quarters of a millimetre: 0.9 m, and none at
// the first pixel.

// NOLINTBEGIN(readability-identifier-naming)
enum rs2_stream { RS2_STREAM_DEPTH, RS2_STREAM_COLOR };
enum rs2_format { RS2_FORMAT_Z16, RS2_FORMAT_RGB8, RS2_FORMAT_BGR8 };

struct rs2_intrinsics {
  int width;
  int height;
  float ppx;
  float ppy;
  float fx;
  float fy;
};

namespace rs2 {

class stream_profile {
 public:
  explicit stream_profile(rs2_format format) : format_(format) {}
  rs2_format format() const { return format_; }
  template <typename Profile>
  Profile as() const {
    return Profile(format_);
  }

 private:
  rs2_format format_;
};

class video_stream_profile : public stream_profile {
 public:
  using stream_profile::stream_profile;
  rs2_intrinsics get_intrinsics() const { return {64, 48, 31.5F, 23.5F, 58.0F, 59.0F}; }
};

class video_frame {
 public:
  video_frame(rs2_format format, std::vector<std::uint8_t> data) : format_(format), data_(std::move(data)) {}
  int get_width() const { return 64; }
  int get_height() const { return 48; }
  int get_stride_in_bytes() const { return format_ == RS2_FORMAT_Z16 ? 128 : 192; }
  const void* get_data() const { return data_.data(); }
  stream_profile get_profile() const { return stream_profile(format_); }

 private:
  rs2_format format_;
  std::vector<std::uint8_t> data_;
};

class depth_frame : public video_frame {
 public:
  using video_frame::video_frame;
  float get_units() const { return 0.00025F; }
};

class frameset {
 public:
  bool of_file = false;

  video_frame get_color_frame() const {
    std::vector<std::uint8_t> red(std::size_t{64} * 48 * 3, 0);
    for (std::size_t i = of_file ? 0 : 2; i < red.size(); i += 3) red[i] = 255;
    return {of_file ? RS2_FORMAT_RGB8 : RS2_FORMAT_BGR8, red};
  }

  depth_frame get_depth_frame() const {
    std::vector<std::uint8_t> steps;
    for (int i = 0; i < 64 * 48; ++i) {
      const int step = i == 0 ? 0 : 3600;
      steps.push_back(static_cast<std::uint8_t>(step & 255));
      steps.push_back(static_cast<std::uint8_t>(step >> 8));
    }
    return {RS2_FORMAT_Z16, steps};
  }
};

class config {
 public:
  std::string file;
  void enable_stream(rs2_stream, int, int, rs2_format, int) {}
  void enable_device_from_file(const std::string& name, bool) { file = name; }
};

class pipeline {
 public:
  void start(const config& wanted) { of_file_ = !wanted.file.empty(); }

  bool try_wait_for_frames(frameset* taken, unsigned) const {
    std::this_thread::sleep_for(std::chrono::milliseconds(33));
    taken->of_file = of_file_;
    return count_++ < 10;
  }

 private:
  bool of_file_ = false;
  mutable int count_ = 0;
};

class align {
 public:
  explicit align(rs2_stream) {}
  frameset process(const frameset& taken) { return taken; }
};

}  // namespace rs2
// NOLINTEND(readability-identifier-naming)
