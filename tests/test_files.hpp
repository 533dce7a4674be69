#pragma once

#include <cerrno>  // program_invocation_short_name
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

#include "pipeline/base/checks.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Returns an empty folder of this test's own, also while other test programs run.
inline std::filesystem::path fresh_folder(const std::string& name) {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / (std::string(program_invocation_short_name) + "_" + name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

/// Returns the text of the InputError that `work` throws; empty where it throws none.
inline std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Replaces the first `from` in a text file.
inline void replace_in_file(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::string text = read_text(file);
  text.replace(text.find(from), from.size(), to);
  write_text(file, text);
}

/// Returns a small frame without structure: colour (10,20,30), depth 1 m, with a hole at the first pixel.
inline RgbdFrame plain_frame(int width = 64, int height = 48) {
  RgbdFrame frame;
  frame.camera = {width, height, 60.0, 61.0, 31.5, 23.5};
  frame.colour = cv::Mat(height, width, CV_8UC3, cv::Scalar(10, 20, 30));
  frame.depth = cv::Mat(height, width, CV_32FC1, cv::Scalar(1.0));
  frame.depth.at<float>(0, 0) = std::numeric_limits<float>::quiet_NaN();
  return frame;
}

/// Returns 255 in `box_px`, else 0.
inline cv::Mat box_mask(const cv::Rect& box_px, int width = 64, int height = 48) {
  cv::Mat mask(height, width, CV_8UC1, cv::Scalar(0));
  mask(box_px).setTo(255);
  return mask;
}

}  // namespace houghstream
