#include "tools/studies/teach/kept_takes.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <opencv2/core.hpp>
#include <sstream>
#include <utility>

#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/fnv.hpp"

namespace houghstream::studies {
namespace {

namespace fs = std::filesystem;

using FramePlace = std::pair<std::size_t, std::size_t>;  // scene, frame

/// Statistics of the pixels.
std::uint64_t fingerprint(const cv::Mat& image) {
  std::uint64_t hash = fnv1a(nullptr, 0);
  for (int y = 0; y < image.rows; ++y)
    hash = fnv1a(image.ptr(y), static_cast<std::size_t>(image.cols) * image.elemSize(), hash);
  return hash;
}

std::map<std::uint64_t, FramePlace> places_of_images(const TrueTakes& takes) {
  std::map<std::uint64_t, FramePlace> places;
  for (std::size_t s = 0; s < takes.scenes.size(); ++s) {
    for (std::size_t f = 0; f < takes.scenes[s].images().size(); ++f)
      places.emplace(fingerprint(takes.scenes[s].read_frame(f).colour), FramePlace(s, f));
  }
  return places;
}

double overlap(const cv::Mat& a, const cv::Mat& b) {
  const int either = cv::countNonZero(a | b);
  return either == 0 ? 0.0 : static_cast<double>(cv::countNonZero(a & b)) / either;
}

std::vector<fs::path> scene_folders(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (fs::exists(entry.path() / "scene_camera.json")) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

ShownPose pose_of_row(const std::vector<double>& row) {
  ShownPose pose;
  pose.frame = static_cast<std::size_t>(row[0]);
  for (int i = 0; i < 12; ++i) pose.T_camera_taught.matrix()(i / 4, i % 4) = row[static_cast<std::size_t>(3 + i)];
  return pose;
}

}  // namespace

TrueTakes read_true_takes(const fs::path& folder, const std::string& object) {
  TrueTakes takes;
  const fs::path file = folder / "takes.json";
  for (const nlohmann::json& entry : read_json_list(file)) {
    if (entry.value("object", "") != object) continue;
    takes.object_id = json_integer(entry, "id", file.string());
    const int scene = json_integer(entry, "scene", file.string());
    takes.scenes.emplace_back(folder / "test" / fmt::format("{:06d}", scene));
  }
  require(!takes.scenes.empty(), "{}: no take of {}, expected at least one", file.string(), object);
  takes.mesh = load_mesh(read_bop_models(folder / "models").mesh_file(takes.object_id));
  return takes;
}

const GroundTruthObject* ground_truth_object(const TrueTakes& takes, std::size_t scene, std::size_t frame) {
  for (const GroundTruthObject& object : takes.scenes.at(scene).images().at(frame).objects) {
    if (object.object_id == takes.object_id) return &object;
  }
  return nullptr;
}

std::vector<ShownPose> read_camera_poses(const fs::path& file) {
  std::ifstream in(file);
  require(in.good(), "{}: cannot be read", file.string());
  std::vector<ShownPose> poses;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (number == 1 || line.empty()) continue;
    std::vector<double> row;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',') && !cell.empty();) row.push_back(std::stod(cell));
    require(row.size() >= 3, "{}: line {}: \"{}\", expected frame, utime, tracked and a matrix", file.string(), number,
            line);
    if (row[2] == 0.0) continue;
    require(row.size() == 15, "{}: line {}: {} numbers, expected 15", file.string(), number, row.size());
    poses.push_back(pose_of_row(row));
  }
  return poses;
}

std::vector<KeptView> read_kept_views(const fs::path& folder, const TrueTakes& takes) {
  const std::map<std::uint64_t, FramePlace> places = places_of_images(takes);
  std::vector<KeptView> views;
  for (const fs::path& scene_folder : scene_folders(folder)) {
    const BopScene scene(scene_folder);
    for (std::size_t i = 0; i < scene.images().size(); ++i) {
      const auto place = places.find(fingerprint(scene.read_frame(i).colour));
      if (place == places.end() || scene.images()[i].objects.empty()) continue;
      KeptView view;
      std::tie(view.pose.scene, view.pose.frame) = place->second;
      view.pose.T_camera_taught = scene.images()[i].objects.front().T_camera_object;
      const GroundTruthObject* object = ground_truth_object(takes, view.pose.scene, view.pose.frame);
      if (object != nullptr) {
        const BopScene& truth = takes.scenes[view.pose.scene];
        const auto index = static_cast<std::size_t>(object - truth.images()[view.pose.frame].objects.data());
        view.mask_iou = overlap(scene.read_mask(i, 0), truth.read_mask(view.pose.frame, index));
      }
      views.push_back(view);
    }
  }
  return views;
}

}  // namespace houghstream::studies
