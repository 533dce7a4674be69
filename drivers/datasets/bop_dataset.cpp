#include "drivers/datasets/bop_dataset.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "drivers/files/image_file.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path colour_file(const fs::path& folder, int image_id) {
  const fs::path png = folder / "rgb" / fmt::format("{:06d}.png", image_id);
  const fs::path jpg = folder / "rgb" / fmt::format("{:06d}.jpg", image_id);
  return fs::exists(jpg) && !fs::exists(png) ? jpg : png;
}

/// The nearest rotation to one that is off by less than a per cent in any direction, as published data are that were
/// rounded or refined (polar decomposition; Higham, "Computing the Polar Decomposition", SIAM J. Sci. Stat. Comput.,
/// 1986). What is a rotation but for the last digits goes through its quaternion.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R, const std::string& where) {
  constexpr double kLastDigits = 1e-3;
  constexpr double kTolerance = 0.01 - 1e-9;
  const double skew = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (skew < kLastDigits && R.determinant() > 0.0) return Eigen::Quaterniond(R).normalized().toRotationMatrix();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> stretch_sq(R.transpose() * R);
  const double off = (stretch_sq.eigenvalues().cwiseMax(0.0).cwiseSqrt().array() - 1.0).abs().maxCoeff();
  require(
      R.determinant() > 0.0 && off < kTolerance,
      "{}: 'cam_R_m2c' is off a rotation by {:.2g} %, its determinant is {:.4g}; expected less than 1 % and a positive "
      "one",
      where, 100.0 * off, R.determinant());
  return R * stretch_sq.operatorInverseSqrt();
}

/// Returns a pose in metres from BOP's row-wise rotation and millimetres.
Eigen::Isometry3d parse_pose(const json& entry, const std::string& where) {
  const std::vector<double> r = json_numbers(entry, "cam_R_m2c", 9, where);
  const std::vector<double> t_mm = json_numbers(entry, "cam_t_m2c", 3, where);
  Eigen::Matrix3d R;
  R << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  const Eigen::Vector3d t(t_mm[0], t_mm[1], t_mm[2]);
  constexpr double kMaxDistance_mm = 1e5;
  require(t.norm() < kMaxDistance_mm, "{}: 'cam_t_m2c' is {} mm long, expected less than {}", where, t.norm(),
          kMaxDistance_mm);
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  T_camera_object.linear() = nearest_rotation(R, where);
  T_camera_object.translation() = t * 1e-3;
  return T_camera_object;
}

cv::Rect parse_box(const json& info, const Camera& camera, const std::string& where) {
  const std::vector<double> b = json_numbers(info, "bbox_visib", 4, where);
  if (b[2] <= 0.0 || b[3] <= 0.0) return {};  // BOP writes -1 or 0 where nothing is visible
  const bool inside = b[0] >= 0.0 && b[1] >= 0.0 && b[0] + b[2] <= camera.width && b[1] + b[3] <= camera.height;
  require(inside, "{}: 'bbox_visib' {},{} {}x{}, expected inside the {}x{} image", where, b[0], b[1], b[2], b[3],
          camera.width, camera.height);
  return {static_cast<int>(std::lround(b[0])), static_cast<int>(std::lround(b[1])), static_cast<int>(std::lround(b[2])),
          static_cast<int>(std::lround(b[3]))};
}

/// Reads an object's entry of scene_gt.json.
GroundTruthObject parse_ground_truth(const json& entry, const std::string& where) {
  GroundTruthObject object;
  object.object_id = json_integer(entry, "obj_id", where);
  require(object.object_id >= 1, "{}: 'obj_id' is {}, expected at least 1", where, object.object_id);
  object.has_pose = entry.contains("cam_R_m2c") || entry.contains("cam_t_m2c");
  if (object.has_pose) object.T_camera_object = parse_pose(entry, where);
  return object;
}

/// Adds the object's entry of scene_gt_info.json.
void add_info(const json& info, const Camera& camera, const std::string& where, GroundTruthObject& object) {
  object.box_visible_px = parse_box(info, camera, where);
  object.visible_fraction = json_number(info, "visib_fract", where);
  require(object.visible_fraction >= 0.0 && object.visible_fraction <= 1.0, "{}: 'visib_fract' is {}, expected 0 to 1",
          where, object.visible_fraction);
}

BopImage parse_image(const json& entry, int image_id, const cv::Size& size_px, const std::string& where) {
  const std::vector<double> k = json_numbers(entry, "cam_K", 9, where);
  require(k[1] == 0.0 && k[3] == 0.0 && k[6] == 0.0 && k[7] == 0.0 && k[8] == 1.0,
          "{}: 'cam_K' has skew or no projective last row, expected fx 0 cx 0 fy cy 0 0 1", where);
  BopImage image;
  image.image_id = image_id;
  image.camera = {size_px.width, size_px.height, k[0], k[4], k[2], k[5]};
  check_camera(image.camera, where);
  image.depth_scale = entry.contains("depth_scale") ? json_number(entry, "depth_scale", where) : 1.0;
  require(image.depth_scale >= 1e-3 && image.depth_scale <= 100.0,
          "{}: 'depth_scale' is {}, expected 0.001 to 100 millimetres a step", where, image.depth_scale);
  return image;
}

/// Returns the image size: from our own keys where they exist, else from the image itself (BOP stores none per image).
cv::Size image_size(const json& entry, const fs::path& folder, int image_id, const std::string& where) {
  if (entry.contains("width") && entry.contains("height")) {
    return {json_integer(entry, "width", where), json_integer(entry, "height", where)};
  }
  return read_colour_image(colour_file(folder, image_id)).size();
}

const json& frame_list(const json& frames, int image_id, const std::string& where) {
  static const json empty = json::array();
  const std::string key = std::to_string(image_id);
  if (!frames.contains(key)) return empty;
  require(frames.at(key).is_array(), "{}: image {} is no list", where, image_id);
  return frames.at(key);
}

/// Throws InputError for images that scene_camera.json lacks, whose objects would be ignored silently.
void require_known_images(const json& frames, const std::vector<BopImage>& images, const std::string& where) {
  std::set<std::string> known;
  for (const BopImage& image : images) known.insert(std::to_string(image.image_id));
  for (const auto& [key, entries] : frames.items()) {
    require(known.count(key) > 0, "{}: image '{}' with {} entries is not in scene_camera.json", where, printable(key),
            entries.size());
  }
}

void read_objects(const fs::path& folder, std::vector<BopImage>& images) {
  const fs::path gt_file = folder / "scene_gt.json";
  if (!fs::exists(gt_file)) return;  // background: a scene without objects
  const fs::path info_file = folder / "scene_gt_info.json";
  const json gt = read_json_object(gt_file);
  const json info = fs::exists(info_file) ? read_json_object(info_file) : json::object();
  require_known_images(gt, images, gt_file.string());
  require_known_images(info, images, info_file.string());
  for (BopImage& image : images) {
    const json& entries = frame_list(gt, image.image_id, gt_file.string());
    const json& infos = frame_list(info, image.image_id, info_file.string());
    require(entries.size() == infos.size(), "{}: image {} has {} entries, expected {} as in scene_gt.json",
            info_file.string(), image.image_id, infos.size(), entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const std::string place = fmt::format(" image {} object {}", image.image_id, i);
      image.objects.push_back(parse_ground_truth(entries[i], gt_file.string() + place));
      add_info(infos[i], image.camera, info_file.string() + place, image.objects.back());
    }
  }
}

}  // namespace

BopScene::BopScene(fs::path folder) : folder_(std::move(folder)) {
  const fs::path camera_file = folder_ / "scene_camera.json";
  const std::map<int, json> entries = read_json_by_id(camera_file);
  require(!entries.empty(), "{}: no images", camera_file.string());
  const int first_id = entries.begin()->first;
  const cv::Size first_size = image_size(entries.begin()->second, folder_, first_id, camera_file.string());
  for (const auto& [image_id, entry] : entries) {
    const std::string where = fmt::format("{} image {}", camera_file.string(), image_id);
    const cv::Size size_px = entry.contains("width") ? image_size(entry, folder_, image_id, where) : first_size;
    images_.push_back(parse_image(entry, image_id, size_px, where));
  }
  read_objects(folder_, images_);
}

RgbdFrame BopScene::read_frame(std::size_t index) const {
  const BopImage& image = images_.at(index);
  const fs::path depth_file = folder_ / "depth" / fmt::format("{:06d}.png", image.image_id);
  RgbdFrame frame;
  frame.id.utime = dataset_utime(index);
  frame.camera = image.camera;
  frame.colour = read_colour_image(colour_file(folder_, image.image_id));
  // Missing depth is NaN, and stays NaN under the scale.
  frame.depth = depth_from_millimetres(read_depth_image(depth_file));
  if (image.depth_scale != 1.0) frame.depth *= image.depth_scale;
  check_frame(frame, depth_file.string());
  return frame;
}

cv::Mat BopScene::read_mask(std::size_t index, std::size_t object_index) const {
  const BopImage& image = images_.at(index);
  const fs::path file = folder_ / "mask_visib" / fmt::format("{:06d}_{:06d}.png", image.image_id, object_index);
  cv::Mat mask = read_mask_image(file);
  require(mask.cols == image.camera.width && mask.rows == image.camera.height, "{}: {}x{}, expected {}x{} as the image",
          file.string(), mask.cols, mask.rows, image.camera.width, image.camera.height);
  return mask;
}

std::int64_t dataset_utime(std::size_t index) {
  constexpr std::int64_t kFirst = 1'500'000'000'000'000;
  return kFirst + static_cast<std::int64_t>(index) * 1'000'000 / kDatasetRateHz;
}

}  // namespace houghstream
