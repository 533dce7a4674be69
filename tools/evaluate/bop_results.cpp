#include "tools/evaluate/bop_results.hpp"

#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;
using Rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr const char* kHeader = "scene_id,im_id,obj_id,score,R,t,time";

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::string part;
  std::istringstream in(text);
  while (std::getline(in, part, separator)) parts.push_back(part);
  return parts;
}

double parse_number(const std::string& text, const std::string& where) {
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  require(result.ec == std::errc() && result.ptr == end && std::isfinite(number), "{}: '{}', expected a number", where,
          text);
  return number;
}

int parse_id(const std::string& text, const std::string& where) {
  int id = -1;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, id);
  require(result.ec == std::errc() && result.ptr == end && id >= 0, "{}: '{}', expected an id from 0 on", where, text);
  return id;
}

std::vector<double> parse_numbers(const std::string& text, std::size_t count, const std::string& where) {
  std::vector<double> numbers;
  for (const std::string& part : split(text, ' ')) numbers.push_back(parse_number(part, where));
  require(numbers.size() == count, "{}: '{}', expected {} numbers", where, text, count);
  return numbers;
}

BopEstimate parse_line(const std::string& line, const std::string& where) {
  const std::vector<std::string> fields = split(line, ',');
  constexpr std::size_t kFields = 7;
  require(fields.size() == kFields, "{}: {} fields, expected {}", where, fields.size(), kFields);
  const std::vector<double> rotation = parse_numbers(fields[4], 9, where);
  const Rotation R = Eigen::Map<const Rotation>(rotation.data());
  constexpr double kTolerance = 1e-3;
  require((R * R.transpose()).isIdentity(kTolerance) && R.determinant() > 0.0, "{}: R is {}, expected a rotation",
          where, fields[4]);
  const std::vector<double> t_mm = parse_numbers(fields[5], 3, where);
  BopEstimate estimate;
  estimate.scene_id = parse_id(fields[0], where);
  estimate.image_id = parse_id(fields[1], where);
  estimate.object_id = parse_id(fields[2], where);
  estimate.score = parse_number(fields[3], where);
  estimate.T_camera_object.linear() = R;
  estimate.T_camera_object.translation() = Eigen::Vector3d(t_mm[0], t_mm[1], t_mm[2]) * 1e-3;
  estimate.time_s = parse_number(fields[6], where);
  return estimate;
}

std::map<std::string, int> ids_by_name(const std::vector<EvaluatedFrame>& frames,
                                       const std::map<int, std::string>& names) {
  std::map<std::string, int> ids;
  for (const auto& [id, name] : names) ids.emplace(name, id);
  for (const EvaluatedFrame& frame : frames) {
    for (const NamedObject& object : frame.objects) ids.emplace(object.class_name, object.truth.object_id);
  }
  return ids;
}

double seconds_of(const std::vector<StageTime>& stages) {
  std::int64_t sum_us = 0;
  for (const StageTime& stage : stages) sum_us += stage.duration_us;
  return stages.empty() ? -1.0 : static_cast<double>(sum_us) * 1e-6;
}

}  // namespace

std::vector<BopEstimate> bop_estimates(const std::vector<EvaluatedFrame>& frames,
                                       const std::map<int, std::string>& names) {
  const std::map<std::string, int> ids = ids_by_name(frames, names);
  std::set<std::string> unknown;
  std::vector<BopEstimate> estimates;
  for (const EvaluatedFrame& frame : frames) {
    if (!frame.poses) continue;
    for (const ObjectPose& pose : frame.poses->poses) {
      if (!pose.T_camera_object) continue;
      const auto id = ids.find(pose.class_name);
      if (id == ids.end()) {
        unknown.insert(pose.class_name);
        continue;
      }
      BopEstimate& estimate = estimates.emplace_back();
      estimate.scene_id = scene_number(frame.scene);
      estimate.image_id = frame.image_id;
      estimate.object_id = id->second;
      estimate.score = static_cast<double>(pose.detection_score);
      estimate.T_camera_object = *pose.T_camera_object;
      estimate.time_s = seconds_of(frame.poses->stages);
    }
  }
  for (const std::string& name : unknown)
    log_warning("{}: poses of '{}' left out, the scene has no id for it", kBopResultsFile, name);
  return estimates;
}

void write_bop_results(const std::vector<BopEstimate>& estimates, const fs::path& file) {
  std::string out = std::string(kHeader) + '\n';
  for (const BopEstimate& estimate : estimates) {
    const Rotation R = estimate.T_camera_object.linear();
    const Eigen::Vector3d t_mm = estimate.T_camera_object.translation() * 1e3;
    out += fmt::format("{},{},{},{},{},{},{}\n", estimate.scene_id, estimate.image_id, estimate.object_id,
                       estimate.score, fmt::join(R.data(), R.data() + R.size(), " "),
                       fmt::join(t_mm.data(), t_mm.data() + t_mm.size(), " "), estimate.time_s);
  }
  write_file_atomically(file, out);
}

std::vector<BopEstimate> read_bop_results(const fs::path& file) {
  std::istringstream in(read_file(file, "BOP results"));
  std::string line;
  require(static_cast<bool>(std::getline(in, line)), "{}: missing or empty, expected '{}'", file.string(), kHeader);
  require(line == kHeader, "{}: begins with '{}', expected '{}'", file.string(), line, kHeader);
  std::vector<BopEstimate> estimates;
  for (int number = 2; std::getline(in, line); ++number)
    estimates.push_back(parse_line(line, fmt::format("{} line {}", file.string(), number)));
  return estimates;
}

}  // namespace houghstream
