#include "tools/evaluate/metrics/latency.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"

namespace houghstream {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::string field;
  std::istringstream in(line);
  while (std::getline(in, field, ',')) {
    if (!field.empty() && field.back() == '\r') field.pop_back();
    fields.push_back(field);
  }
  if (!line.empty() && line.back() == ',') fields.emplace_back();
  return fields;
}

std::optional<double> parse_time(const std::string& text, const std::string& where) {
  if (text.empty()) return std::nullopt;
  double seconds = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), seconds);
  require(result.ec == std::errc() && result.ptr == text.data() + text.size() && std::isfinite(seconds),
          "{}: '{}', expected seconds", where, text);
  return seconds;
}

std::size_t column(const std::vector<std::string>& header, const std::string& name, const std::string& file) {
  const auto found = std::find(header.begin(), header.end(), name);
  require(found != header.end(), "{}: no column '{}'", file, name);
  return static_cast<std::size_t>(found - header.begin());
}

void append_difference(const std::optional<double>& from, const std::optional<double>& to,
                       std::vector<double>& out_ms) {
  if (from && to && *from <= *to) out_ms.push_back((*to - *from) * 1e3);
}

}  // namespace

Latencies read_latencies(const std::filesystem::path& csv_file) {
  const std::string file = csv_file.string();
  std::istringstream in(read_file(csv_file, "the times of frames"));
  std::string line;
  require(static_cast<bool>(std::getline(in, line)), "{}: missing or empty, expected hs-observe's CSV", file);
  const std::vector<std::string> header = split(line);
  const std::size_t frame = column(header, "t_frame", file);
  const std::size_t detections = column(header, "t_detections", file);
  const std::size_t poses = column(header, "t_poses", file);
  Latencies out;
  for (int number = 2; std::getline(in, line); ++number) {
    const std::string where = fmt::format("{} line {}", file, number);
    const std::vector<std::string> fields = split(line);
    require(fields.size() == header.size(), "{}: {} fields, expected {}", where, fields.size(), header.size());
    const auto t_frame = parse_time(fields[frame], where);
    const auto t_detections = parse_time(fields[detections], where);
    const auto t_poses = parse_time(fields[poses], where);
    out.frames += t_frame ? 1 : 0;
    append_difference(t_frame, t_detections, out.detect_ms);
    append_difference(t_detections, t_poses, out.pose_ms);
    append_difference(t_frame, t_poses, out.total_ms);
  }
  return out;
}

}  // namespace houghstream
