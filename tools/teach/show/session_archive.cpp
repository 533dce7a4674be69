#include "tools/teach/show/session_archive.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/folder_exchange.hpp"
#include "pipeline/base/html_text.hpp"
#include "pose/reconstruction/model/take_model.hpp"
#include "tools/fuse/model_image.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using reconstruction::LostSpan;
using reconstruction::MaskedKeyframe;
using reconstruction::RegisteredFrame;
using reconstruction::Take;

void write_poses(const ShowResult& shown, const fs::path& file) {
  std::ofstream out(file);
  out << "frame,utime,tracked,r11,r12,r13,t1,r21,r22,r23,t2,r31,r32,r33,t3\n";
  const Take& take = shown.takes.front();
  const MaskedKeyframe& any = shown.views.front().front();
  const Eigen::Isometry3d T_world_object =
      take.keyframes[static_cast<std::size_t>(any.keyframe)].T_camera_world.inverse() * any.T_camera_object;
  for (std::size_t i = 0; i < take.frames.size(); ++i) {
    const RegisteredFrame& frame = take.frames[i];
    out << fmt::format("{},{},{}", i, frame.id.utime, frame.tracked ? 1 : 0);
    const Eigen::Isometry3d T = frame.tracked ? take.pose_of(frame) * T_world_object : Eigen::Isometry3d::Identity();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column)
        out << (frame.tracked ? fmt::format(",{:.7f}", T.matrix()(row, column)) : ",");
    }
    out << "\n";
  }
  out.close();
  require(out.good(), "{}: cannot be written", file.string());
}

OrderedJson report_json(const ShowResult& shown, const ModelAssessment& assessment) {
  OrderedJson json;
  int frames = 0, tracked = 0, keyframes = 0;
  double hz = 1e9;
  OrderedJson lost = OrderedJson::array();
  OrderedJson drift_mm, drift_deg;
  for (const Take& take : shown.takes) {
    frames += static_cast<int>(take.frames.size());
    tracked += tracked_frames(take);
    keyframes += static_cast<int>(take.keyframes.size());
    hz = std::min(hz, take.tracking_hz);
    for (const LostSpan& span : take.lost)
      lost.push_back({{"from", second_of(take, span.from)}, {"to", second_of(take, span.to)}, {"why", span.why}});
    if (!take.loop_error) continue;  // the worst of several takes counts
    drift_mm = std::max(1e3 * take.loop_error->shift_m, drift_mm.is_null() ? 0.0 : drift_mm.get<double>());
    drift_deg = std::max(degrees_of(*take.loop_error), drift_deg.is_null() ? 0.0 : drift_deg.get<double>());
  }
  json["name"] = shown.name;
  json["verdict"] = assessment.good ? "good" : "poor";
  json["reasons"] = assessment.reasons;
  json["frames"] = frames;
  json["used_frames"] = tracked;
  json["keyframes"] = keyframes;
  json["seconds"] = shown.seconds;
  json["tracking_hz"] = hz;
  json["drift_mm"] = drift_mm;
  json["drift_deg"] = drift_deg;
  json["agreement_mm"] = 1e3 * shown.deviation_m;
  json["seen_through"] = shown.free_space_violation;
  json["outline_overlap"] = shown.silhouette_iou ? OrderedJson(*shown.silhouette_iou) : OrderedJson();
  json["seen_share"] =
      static_cast<double>(reconstruction::count_covered(seen_by_all(shown))) / reconstruction::kSphereDirections;
  json["seen_surface"] = shown.seen_surface;
  json["degrees_round"] = shown.takes.front().covered_degrees;
  json["lost"] = lost;
  json["diameter_mm"] = 1e3 * mesh_diameter(shown.mesh);
  return json;
}

/// Returns the keyframes of all takes.
std::vector<TrainingView> all_views(const ShowResult& shown) {
  std::vector<TrainingView> views;
  for (std::size_t t = 0; t < shown.takes.size(); ++t) {
    std::vector<TrainingView> of_take = training_views(shown.takes[t], shown.views[t], shown.name);
    std::move(of_take.begin(), of_take.end(), std::back_inserter(views));
  }
  return views;
}

/// Draws the model's outline over a keyframe, and its mask where that ends elsewhere.
cv::Mat outline_image(const Mesh& mesh, const TrainingView& view) {
  RgbdFrame nothing_hides = view.frame;
  nothing_hides.depth = cv::Mat(view.frame.depth.size(), CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  cv::Mat image = view.frame.colour.clone();
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(view.mask.clone(), outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::drawContours(image, outlines, -1, {0, 200, 255}, 1);
  cv::findContours(reconstruction::render_visible_mask(mesh, nothing_hides, view.T_camera_object), outlines,
                   cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::drawContours(image, outlines, -1, {0, 255, 0}, 1);
  return image;
}

/// Draws the selected object in a take's first frame; that of turntable videos is given by their masks.
void write_choices(const ShowResult& shown, const fs::path& folder) {
  for (std::size_t t = 0; t < shown.takes.size(); ++t) {
    const Take& take = shown.takes[t];
    if (take.selected.mask.empty()) continue;
    cv::Mat image = take.keyframes.front().frame.colour.clone();
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(take.selected.mask.clone(), outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::drawContours(image, outlines, -1, {0, 255, 0}, 2);
    write_png(image, folder / (t == 0 ? "chosen.png" : "chosen_2.png"));
  }
}

void write_images(const ShowResult& shown, const std::vector<TrainingView>& views, const fs::path& folder) {
  constexpr std::size_t kOutlines = 12;
  write_choices(shown, folder);
  fs::create_directories(folder / "outlines");
  const std::size_t step = std::max<std::size_t>(1, views.size() / kOutlines);
  for (std::size_t i = 0; i < views.size(); i += step)
    write_png(outline_image(shown.mesh, views[i]), folder / "outlines" / fmt::format("{:06d}.png", i));
  cv::Mat sheet = view_image(views, fmt::format("{}: {} keyframes", shown.name, views.size()));
  cv::Mat model = draw_model(shown.mesh);
  cv::resize(model, model, {sheet.cols, model.rows * sheet.cols / model.cols}, 0, 0, cv::INTER_AREA);
  sheet.push_back(model);
  write_image(sheet, folder / "contact_sheet.jpg");
}

void write_views(const ShowResult& shown, const std::vector<TrainingView>& views, const fs::path& folder) {
  BopWriter writer(folder / "000001");
  for (const TrainingView& view : views) {
    GroundTruthObject object;
    object.object_id = 1;
    object.T_camera_object = view.T_camera_object;
    object.box_visible_px = cv::boundingRect(view.mask);
    writer.add(view.frame, {object}, {view.mask});
  }
  writer.finish();
  write_bop_models({{1, shown.name, shown.mesh, {}}}, folder / "models");
}

/// Returns the folder's place: a slash at the end names the folder itself, not something in it.
fs::path kept_folder(const fs::path& folder) {
  return fs::absolute(folder / "").lexically_normal().parent_path();
}

/// Returns whether the path, relative to a kept folder, is one that a showing writes. All else is somebody's.
bool is_kept_entry(const fs::path& relative) {
  static const std::set<std::string> names = {"model.ply",   "model.png",    "views",    "contact_sheet.jpg",
                                              "chosen.png",  "chosen_2.png", "outlines", "camera_poses.csv",
                                              "report.json", "report.html"};
  const std::string first = relative.begin()->string();
  if (names.count(first) == 0) return false;
  const auto second = std::next(relative.begin());
  if (second == relative.end()) return true;
  if (first == "outlines")
    return second->extension() == ".png" && second->string().find_first_not_of("0123456789.png") == std::string::npos;
  return *second == "000001" || *second == "models";
}

void write_page(const ShowResult& shown, const ModelAssessment& assessment, const fs::path& folder) {
  SessionImages images;
  for (const char* name : {"chosen.png", "chosen_2.png"}) {
    if (fs::exists(folder / name)) images.selected.emplace_back(name);
  }
  for (const auto& entry : fs::directory_iterator(folder / "outlines"))
    images.outlines.push_back("outlines/" + entry.path().filename().string());
  std::sort(images.outlines.begin(), images.outlines.end());
  std::ofstream out(folder / "report.html");
  out << report_page(shown, assessment, images);
  out.close();
  require(out.good(), "{}: cannot be written", (folder / "report.html").string());
}

}  // namespace

std::string report_page(const ShowResult& shown, const ModelAssessment& assessment, const SessionImages& images) {
  std::string page =
      fmt::format("<!doctype html><meta charset=\"utf-8\"><title>{0}</title>\n<h1>{0}: {1}</h1>\n<pre>{2}</pre>\n",
                  escape_html(shown.name), assessment.good ? "good" : "poor", escape_html(describe(shown, assessment)));
  for (const std::string& file : images.selected)
    page += fmt::format("<p>Taken for the object in the first frame:</p>\n<img src=\"{}\" width=\"50%\">\n",
                        escape_html(file));
  page +=
      "<p>Some keyframes, and the model in its colours and as shape:</p>\n<img src=\"contact_sheet.jpg\" "
      "width=\"100%\">\n"
      "<p>The model's outline (green) and the mask (orange) over keyframes:</p>\n";
  for (const std::string& file : images.outlines)
    page += fmt::format("<img src=\"{}\" width=\"32%\">\n", escape_html(file));
  return page;
}

void require_keepable(const fs::path& folder) {
  const fs::path whole = kept_folder(folder);
  const bool is_earlier = fs::exists(whole / "report.json") && fs::exists(whole / "camera_poses.csv");
  require(!fs::exists(whole) || (fs::is_directory(whole) && (fs::is_empty(whole) || is_earlier)),
          "{}: holds something else, expected a new folder or one of an earlier showing", folder.string());
  require_writable_folder(whole.parent_path());
  require_exchangeable(whole, is_kept_entry);
}

void archive_session(const ShowResult& shown, const ModelAssessment& assessment, const fs::path& folder) {
  require_keepable(folder);
  const fs::path whole = kept_folder(folder);
  const fs::path partial = whole.parent_path() / fmt::format(".{}.partial-{}", whole.filename().string(), getpid());
  try {
    fs::create_directories(partial);
    const std::vector<TrainingView> views = all_views(shown);
    save_ply(shown.mesh, partial / "model.ply");
    write_views(shown, views, partial / "views");
    write_images(shown, views, partial);
    write_poses(shown, partial / "camera_poses.csv");
    write_json(report_json(shown, assessment), partial / "report.json");
    write_page(shown, assessment, partial);
    restore_replaced(whole, is_kept_entry);
    exchange_folder(partial, whole, is_kept_entry);
  } catch (const std::exception& error) {
    std::error_code ignored;
    fs::remove_all(partial, ignored);
    fail("{}: cannot be written: {}", folder.string(), error.what());
  }
}

}  // namespace houghstream::teach
