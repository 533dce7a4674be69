#include "drivers/datasets/bop_symmetries.hpp"

#include <cmath>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

constexpr const char* kDiscrete = "symmetries_discrete";
constexpr const char* kContinuous = "symmetries_continuous";
constexpr std::size_t kMax = 256;  // they are combined with one another
constexpr double kMaxDistance_mm = 1e5;

const nlohmann::json& listed(const nlohmann::json& entry, const char* key, const std::string& where) {
  const nlohmann::json& list = entry.at(key);
  require(list.is_array(), "{}: '{}' is {}, expected a list", where, key, json_text(list));
  require(list.size() <= kMax, "{}: '{}' lists {}, expected at most {}", where, key, list.size(), kMax);
  return list;
}

/// Reads a rigid motion; `holder` is an object of one key: json_numbers() names the key in its messages.
Eigen::Isometry3d parse_motion(const nlohmann::json& holder, const std::string& where) {
  const Matrix4 m = Eigen::Map<const Matrix4>(json_numbers(holder, kDiscrete, 16, where).data());
  const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
  constexpr double kTolerance = 1e-3;
  const bool rigid = (R * R.transpose()).isIdentity(kTolerance) && R.determinant() > 0.0 &&
                     m.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0), kTolerance) &&
                     m.topRightCorner<3, 1>().cwiseAbs().maxCoeff() < kMaxDistance_mm;
  require(rigid, "{}: '{}' holds {}, expected rigid motions", where, kDiscrete, json_text(holder.at(kDiscrete)));
  Eigen::Isometry3d motion(Eigen::Quaterniond(R).normalized());
  motion.translation() = m.topRightCorner<3, 1>() * 1e-3;
  return motion;
}

}  // namespace

Symmetries symmetries_from_json(const nlohmann::json& entry, const std::string& where) {
  Symmetries symmetries;
  if (entry.contains(kDiscrete)) {
    for (const nlohmann::json& motion : listed(entry, kDiscrete, where))
      symmetries.discrete.push_back(parse_motion({{kDiscrete, motion}}, where));
  }
  if (entry.contains(kContinuous)) {
    for (const nlohmann::json& axis : listed(entry, kContinuous, where))
      symmetries.continuous.push_back(axis_from_json(axis, kContinuous, where));
  }
  return symmetries;
}

void add_symmetries(const Symmetries& symmetries, OrderedJson& entry) {
  for (const Eigen::Isometry3d& motion : symmetries.discrete) {
    Matrix4 m = motion.matrix();
    m.topRightCorner<3, 1>() *= 1e3;
    entry[kDiscrete].push_back(std::vector<double>(m.data(), m.data() + m.size()));
  }
  for (const ContinuousSymmetry& symmetry : symmetries.continuous) entry[kContinuous].push_back(axis_to_json(symmetry));
}

ContinuousSymmetry axis_from_json(const nlohmann::json& entry, const std::string& key, const std::string& where) {
  const std::vector<double> axis = json_numbers(entry, "axis", 3, where);
  const std::vector<double> offset_mm = json_numbers(entry, "offset", 3, where);
  const Eigen::Vector3d direction(axis[0], axis[1], axis[2]);
  constexpr double kMinDuration = 1e-6;
  require(direction.norm() > kMinDuration && std::isfinite(direction.norm()),
          "{}: 'axis' of '{}' has length {}, expected a direction", where, key, direction.norm());
  for (const double offset : offset_mm)
    require(std::abs(offset) < kMaxDistance_mm, "{}: 'offset' of '{}' is {} mm, expected less than {}", where, key,
            offset, kMaxDistance_mm);
  return {direction.normalized(), Eigen::Vector3d(offset_mm[0], offset_mm[1], offset_mm[2]) * 1e-3};
}

OrderedJson axis_to_json(const ContinuousSymmetry& symmetry) {
  const Eigen::Vector3d& axis = symmetry.axis;
  const Eigen::Vector3d offset_mm = symmetry.offset * 1e3;
  return {{"axis", {axis.x(), axis.y(), axis.z()}}, {"offset", {offset_mm.x(), offset_mm.y(), offset_mm.z()}}};
}

}  // namespace houghstream
