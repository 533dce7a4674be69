#include "tools/studies/recorded/pose_agreement.hpp"

#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/bus/percentiles.hpp"
#include "pose/model/angles.hpp"
#include "pose/model/symmetry.hpp"

namespace houghstream {
namespace {

using nlohmann::json;

Eigen::Matrix3d read_rotation(const json& entry, const std::string& where) {
  require(entry.contains("R_m2c") && entry.at("R_m2c").is_array() && entry.at("R_m2c").size() == 3,
          "{}: no R_m2c of three rows", where);
  Eigen::Matrix3d R;
  for (int row = 0; row < 3; ++row) {
    const json line = {{"row", entry.at("R_m2c").at(static_cast<std::size_t>(row))}};
    R.row(row) = Eigen::Map<const Eigen::RowVector3d>(json_numbers(line, "row", 3, where).data());
  }
  constexpr double kRounding = 1e-3;
  require((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < kRounding && R.determinant() > 0.0,
          "{}: R_m2c is no rotation", where);
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

ReferencePose read_pose(const json& entry, const std::string& where) {
  ReferencePose pose;
  pose.T_camera_object.linear() = read_rotation(entry, where);
  const std::vector<double> t = json_numbers(entry, "t_m2c_mm", 3, where);
  pose.T_camera_object.translation() = 1e-3 * Eigen::Vector3d(t[0], t[1], t[2]);
  require(entry.contains("reliable") && entry.at("reliable").is_boolean(), "{}: no 'reliable'", where);
  pose.reliable = entry.at("reliable").get<bool>();
  return pose;
}

}  // namespace

std::map<std::string, ReferencePose> read_reference_poses(const std::filesystem::path& file) {
  const json poses = read_json_object(file);
  require(poses.contains("poses") && poses.at("poses").is_array(), "{}: no list 'poses'", file.string());
  std::map<std::string, ReferencePose> out;
  for (const json& entry : poses.at("poses")) {
    require(entry.is_object() && entry.contains("frame") && entry.at("frame").is_string(), "{}: a pose without 'frame'",
            file.string());
    const auto frame = entry.at("frame").get<std::string>();
    const bool is_first = out.emplace(frame, read_pose(entry, file.string() + " frame " + frame)).second;
    require(is_first, "{}: two poses of frame {}", file.string(), frame);
  }
  return out;
}

PoseDifference compare_poses(const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_reference,
                             const Symmetries& symmetries) {
  const Eigen::Isometry3d T = nearest_equivalent(T_estimated, T_reference, symmetries);
  const double angle = Eigen::Quaterniond(T.linear()).angularDistance(Eigen::Quaterniond(T_reference.linear()));
  return {(T.translation() - T_reference.translation()).norm(), angle / kRadPerDeg};
}

AgreementSummary summarise(const std::vector<ComparedFrame>& frames) {
  constexpr double kShift_m = 0.005;
  constexpr double kAngle_deg = 5.0;
  AgreementSummary summary;
  std::vector<double> shifts;
  std::vector<double> rotations;
  for (const ComparedFrame& frame : frames) {
    if (!frame.reliable) continue;
    ++summary.frames;
    if (!frame.difference) continue;
    shifts.push_back(frame.difference->shift_m);
    rotations.push_back(frame.difference->angle_deg);
    summary.within_5mm_5deg += shifts.back() <= kShift_m && rotations.back() <= kAngle_deg ? 1 : 0;
  }
  summary.with_pose = static_cast<int>(shifts.size());
  if (!shifts.empty()) summary.median = PoseDifference{percentiles(shifts).p50, percentiles(rotations).p50};
  return summary;
}

}  // namespace houghstream
