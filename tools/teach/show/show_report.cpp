#include "tools/teach/show/show_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pose/reconstruction/take_merging.hpp"
#include "tools/fuse/model_picture.hpp"
#include "tools/teach/contact_sheet.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using reconstruction::FrameTrack;
using reconstruction::LostSpan;
using reconstruction::Motion;
using reconstruction::ShownView;
using reconstruction::Take;

constexpr double kDegrees = 57.29577951308232;

int tracked_frames(const Take& take) {
  return static_cast<int>(
      std::count_if(take.frames.begin(), take.frames.end(), [](const FrameTrack& frame) { return frame.tracked; }));
}

int lost_frames(const Take& take) {
  int count = 0;
  for (const LostSpan& span : take.lost) count += span.to - span.from + 1;
  return count;
}

reconstruction::SeenDirections seen_by_all(const Shown& shown) {
  reconstruction::SeenDirections seen{};
  for (const Take& take : shown.takes) {
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = seen[i] || take.seen[i];
  }
  return seen;
}

std::string span_text(const Take& take, const LostSpan& span) {
  return fmt::format("lost between second {:.1f} and {:.1f}: {}", second_of(take, span.from), second_of(take, span.to),
                     span.why);
}

/// Why it was seen from few sides, where that was not for want of frames.
std::string unused_frames(const Take& take) {
  constexpr double kMany = 0.3;
  if (take.blurred + take.badly_exposed <= kMany * static_cast<double>(take.frames.size())) return {};
  return fmt::format("; of {} frames {} were blurred and {} too dark or burnt out, which count for nothing",
                     take.frames.size(), take.blurred, take.badly_exposed);
}

/// What speaks against a take.
void judge_take(const Take& take, std::vector<std::string>& reasons) {
  constexpr int kNearlyRound = 300;
  constexpr int kRound = 350;
  constexpr double kMostLost = 0.15;
  constexpr double kMostGap_m = 0.03;
  constexpr double kMostGapTurn = 0.12;
  if (take.motion == Motion::kUnknown)
    reasons.emplace_back(
        "neither the camera nor the object was seen to move, expected a turn about it (a plain round "
        "object that turns by itself looks as if it stood still)");
  if (take.degrees_round < kNearlyRound)
    reasons.push_back(fmt::format("too short: seen from {} degrees of the turn, expected all 360{}", take.degrees_round,
                                  unused_frames(take)));
  else if (take.degrees_round >= kRound && !take.gap)
    reasons.emplace_back(
        "it came round, and did not find its beginning again: nothing tells how it turned, or the way was lost");
  if (lost_frames(take) > kMostLost * static_cast<double>(take.frames.size())) {
    for (const LostSpan& span : take.lost) {
      if (reasons.size() < 8) reasons.push_back(span_text(take, span));
    }
  }
  if (take.gap && (take.gap->shift_m > kMostGap_m || take.gap->turn > kMostGapTurn))
    reasons.push_back(fmt::format("the turn missed its beginning by {:.0f} mm and {:.1f} degrees",
                                  1e3 * take.gap->shift_m, kDegrees * take.gap->turn));
}

/// What speaks against each of the takes.
void judge_takes(const Shown& shown, std::vector<std::string>& reasons) {
  constexpr std::size_t kFewestKeyframes = 8;
  for (std::size_t t = 0; t < shown.takes.size(); ++t) {
    std::vector<std::string> of_take;
    if (shown.takes[t].motion != Motion::kTurntable) judge_take(shown.takes[t], of_take);
    if (shown.views[t].size() < kFewestKeyframes)
      of_take.push_back(fmt::format("only {} keyframes show it", shown.views[t].size()));
    for (const std::string& reason : of_take) reasons.push_back((t == 0 ? "" : "the second take: ") + reason);
  }
}

void write_poses(const Shown& shown, const fs::path& file) {
  std::ofstream out(file);
  out << "frame,utime,tracked,r11,r12,r13,t1,r21,r22,r23,t2,r31,r32,r33,t3\n";
  const Take& take = shown.takes.front();
  const ShownView& any = shown.views.front().front();
  const Eigen::Isometry3d T_world_object =
      take.keyframes[static_cast<std::size_t>(any.keyframe)].T_camera_world.inverse() * any.T_camera_object;
  for (std::size_t i = 0; i < take.frames.size(); ++i) {
    const FrameTrack& frame = take.frames[i];
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

OrderedJson report_json(const Shown& shown, const Verdict& verdict) {
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
    if (!take.gap) continue;  // of several takes the worst one tells
    drift_mm = std::max(1e3 * take.gap->shift_m, drift_mm.is_null() ? 0.0 : drift_mm.get<double>());
    drift_deg = std::max(kDegrees * take.gap->turn, drift_deg.is_null() ? 0.0 : drift_deg.get<double>());
  }
  json["name"] = shown.name;
  json["verdict"] = verdict.good ? "good" : "poor";
  json["reasons"] = verdict.reasons;
  json["frames"] = frames;
  json["used_frames"] = tracked;
  json["keyframes"] = keyframes;
  json["seconds"] = shown.seconds;
  json["tracking_hz"] = hz;
  json["drift_mm"] = drift_mm;
  json["drift_deg"] = drift_deg;
  json["agreement_mm"] = 1e3 * shown.agreement_m;
  json["seen_through"] = shown.seen_through;
  json["outline_overlap"] = shown.outline_overlap ? OrderedJson(*shown.outline_overlap) : OrderedJson();
  json["seen_share"] =
      static_cast<double>(reconstruction::count_seen(seen_by_all(shown))) / reconstruction::kSphereDirections;
  json["seen_surface"] = shown.seen_surface;
  json["degrees_round"] = shown.takes.front().degrees_round;
  json["lost"] = lost;
  json["diameter_mm"] = 1e3 * mesh_diameter(shown.mesh);
  return json;
}

/// The keyframes of all takes.
std::vector<TrainingView> all_views(const Shown& shown) {
  std::vector<TrainingView> views;
  for (std::size_t t = 0; t < shown.takes.size(); ++t) {
    std::vector<TrainingView> of_take = training_views(shown.takes[t], shown.views[t], shown.name);
    std::move(of_take.begin(), of_take.end(), std::back_inserter(views));
  }
  return views;
}

/// The model's outline over a keyframe, and its mask where that ends elsewhere.
cv::Mat outline_picture(const Mesh& mesh, const TrainingView& view) {
  RgbdFrame nothing_hides = view.frame;
  nothing_hides.depth = cv::Mat(view.frame.depth.size(), CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  cv::Mat picture = view.frame.colour.clone();
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(view.mask.clone(), outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::drawContours(picture, outlines, -1, {0, 200, 255}, 1);
  cv::findContours(reconstruction::mask_of(mesh, nothing_hides, view.T_camera_object), outlines, cv::RETR_EXTERNAL,
                   cv::CHAIN_APPROX_NONE);
  cv::drawContours(picture, outlines, -1, {0, 255, 0}, 1);
  return picture;
}

/// What was taken for the object in a take's first frame; that of turntable videos is given by their masks.
void write_choices(const Shown& shown, const fs::path& folder) {
  for (std::size_t t = 0; t < shown.takes.size(); ++t) {
    const Take& take = shown.takes[t];
    if (take.chosen.mask.empty()) continue;
    cv::Mat picture = take.keyframes.front().frame.colour.clone();
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(take.chosen.mask.clone(), outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::drawContours(picture, outlines, -1, {0, 255, 0}, 2);
    write_png(picture, folder / (t == 0 ? "chosen.png" : "chosen_2.png"));
  }
}

void write_pictures(const Shown& shown, const std::vector<TrainingView>& views, const fs::path& folder) {
  constexpr std::size_t kOutlines = 12;
  write_choices(shown, folder);
  fs::create_directories(folder / "outlines");
  const std::size_t step = std::max<std::size_t>(1, views.size() / kOutlines);
  for (std::size_t i = 0; i < views.size(); i += step)
    write_png(outline_picture(shown.mesh, views[i]), folder / "outlines" / fmt::format("{:06d}.png", i));
  cv::Mat sheet = view_picture(views, fmt::format("{}: {} keyframes", shown.name, views.size()));
  cv::Mat model = draw_model(shown.mesh);
  cv::resize(model, model, {sheet.cols, model.rows * sheet.cols / model.cols}, 0, 0, cv::INTER_AREA);
  sheet.push_back(model);
  write_image(sheet, folder / "contact_sheet.jpg");
}

void write_views(const Shown& shown, const std::vector<TrainingView>& views, const fs::path& folder) {
  BopWriter writer(folder / "000001");
  for (const TrainingView& view : views) {
    TrueObject object;
    object.object_id = 1;
    object.T_camera_object = view.T_camera_object;
    object.box_visible_px = cv::boundingRect(view.mask);
    writer.add(view.frame, {object}, {view.mask});
  }
  writer.finish();
  write_bop_models({{1, shown.name, shown.mesh, {}}}, folder / "models");
}

const char* what_moved(Motion motion) {
  switch (motion) {
    case Motion::kCamera: return "the camera moved";
    case Motion::kObject: return "the object moved";
    case Motion::kTurntable: return "a turntable moved";
    case Motion::kUnknown: break;
  }
  return "nothing moved";
}

/// How it went, a few lines. Turntable videos are not tracked, nor is their turn closed: their masks place them.
std::string describe_take(const Take& take) {
  if (take.motion == Motion::kTurntable)
    return fmt::format("  {} pictures with masks; {}\n", take.keyframes.size(), what_moved(take.motion));
  std::string text = fmt::format("  {}\n", reconstruction::describe_choice(take.chosen));
  text += fmt::format(
      "  {} frames in {:.1f} s, {} tracked, {} keyframes, {} blurred, {} badly exposed; {}; tracked at {:.0f} Hz\n",
      take.frames.size(), second_of(take, static_cast<int>(take.frames.size()) - 1), tracked_frames(take),
      take.keyframes.size(), take.blurred, take.badly_exposed, what_moved(take.motion), take.tracking_hz);
  for (const LostSpan& span : take.lost) text += "  " + span_text(take, span) + "\n";
  text += take.gap
              ? fmt::format("  the turn's end missed its beginning by {:.1f} mm and {:.2f} degrees, and was closed\n",
                            1e3 * take.gap->shift_m, kDegrees * take.gap->turn)
              : "  the turn was not closed\n";
  return text;
}

/// Where it lies: a slash at the end names the folder itself, not something in it.
fs::path kept_folder(const fs::path& folder) {
  return fs::absolute(folder / "").lexically_normal().parent_path();
}

void write_page(const Shown& shown, const Verdict& verdict, const fs::path& folder) {
  std::ofstream out(folder / "report.html");
  out << fmt::format("<!doctype html><meta charset=\"utf-8\"><title>{0}</title>\n<h1>{0}: {1}</h1>\n<pre>{2}</pre>\n",
                     shown.name, verdict.good ? "good" : "poor", describe(shown, verdict));
  for (const char* name : {"chosen.png", "chosen_2.png"}) {
    if (fs::exists(folder / name))
      out << fmt::format("<p>Taken for the object in the first frame:</p>\n<img src=\"{}\" width=\"50%\">\n", name);
  }
  out << "<p>Some keyframes, and the model in its colours and as shape:</p>\n<img src=\"contact_sheet.jpg\" "
         "width=\"100%\">\n"
      << "<p>The model's outline (green) and the mask (orange) over keyframes:</p>\n";
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder / "outlines"))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) out << fmt::format("<img src=\"outlines/{}\" width=\"32%\">\n", name);
  out.close();
  require(out.good(), "{}: cannot be written", (folder / "report.html").string());
}

}  // namespace

double second_of(const Take& take, int frame) {
  return seconds_between(take.frames.front().id.utime, take.frames[static_cast<std::size_t>(frame)].id.utime);
}

double share_of_seen(const std::vector<bool>& seen) {
  return static_cast<double>(std::count(seen.begin(), seen.end(), true)) /
         static_cast<double>(std::max<std::size_t>(1, seen.size()));
}

Verdict judge(const Shown& shown) {
  constexpr double kMostDisagreement_m = 0.003;
  constexpr double kLeastSurface = 0.55;
  constexpr double kLeastOverlap = 0.9;
  Verdict verdict;
  judge_takes(shown, verdict.reasons);
  if (shown.agreement_m > kMostDisagreement_m)
    verdict.reasons.push_back(fmt::format("the views disagree by {:.1f} mm, expected less than {:.0f}",
                                          1e3 * shown.agreement_m, 1e3 * kMostDisagreement_m));
  if (shown.outline_overlap.value_or(1.0) < kLeastOverlap)
    verdict.reasons.push_back(fmt::format("the model's outline overlaps with the masks by {:.2f}, expected at least {}",
                                          *shown.outline_overlap, kLeastOverlap));
  if (shown.seen_surface < kLeastSurface)
    verdict.reasons.push_back(fmt::format("only {:.0f} % of its surface was seen", 100.0 * shown.seen_surface));
  if (shown.seen_through > reconstruction::kMostSeenThrough)
    verdict.reasons.push_back(
        fmt::format("the model is seen through in {:.0f} % of its outline, expected less than {:.0f}: a hand or the "
                    "table was taken for it",
                    100.0 * shown.seen_through, 100.0 * reconstruction::kMostSeenThrough));
  if (!shown.second_fits)
    verdict.reasons.emplace_back(
        "the second take does not fit the first, or shows a hand or the table as if they were the object, expected the "
        "same object, another side up");
  verdict.good = verdict.reasons.empty();
  return verdict;
}

std::string describe(const Shown& shown, const Verdict& verdict) {
  const Take& take = shown.takes.front();
  std::string text = fmt::format("{}: {}\n", shown.name, verdict.good ? "good" : "poor");
  for (const std::string& reason : verdict.reasons) text += "  " + reason + "\n";
  const Eigen::Vector3d front = take.chosen.T_camera_stand.inverse().translation();
  text += fmt::format("  {}\n", reconstruction::describe_seen(seen_by_all(shown), front));
  for (const Take& one : shown.takes) text += describe_take(one);
  text +=
      fmt::format("  {:.0f} mm across, views agree within {:.2f} mm, {:.0f} % of the surface seen; {:.1f} s\n",
                  1e3 * mesh_diameter(shown.mesh), 1e3 * shown.agreement_m, 100.0 * shown.seen_surface, shown.seconds);
  return text;
}

void require_keepable(const fs::path& folder) {
  const fs::path whole = kept_folder(folder);
  const bool is_earlier = fs::exists(whole / "report.json") && fs::exists(whole / "camera_poses.csv");
  require(!fs::exists(whole) || (fs::is_directory(whole) && (fs::is_empty(whole) || is_earlier)),
          "{}: holds something else, expected a new folder or one of an earlier showing", folder.string());
  require_writable_folder(whole.parent_path());
}

void keep_shown(const Shown& shown, const Verdict& verdict, const fs::path& folder) {
  require_keepable(folder);
  const fs::path whole = kept_folder(folder);
  const fs::path partial = whole.parent_path() / fmt::format(".{}.partial-{}", whole.filename().string(), getpid());
  try {
    fs::create_directories(partial);
    const std::vector<TrainingView> views = all_views(shown);
    save_ply(shown.mesh, partial / "model.ply");
    write_views(shown, views, partial / "views");
    write_pictures(shown, views, partial);
    write_poses(shown, partial / "camera_poses.csv");
    write_json(report_json(shown, verdict), partial / "report.json");
    write_page(shown, verdict, partial);
    const fs::path before = whole.parent_path() / fmt::format(".{}.before-{}", whole.filename().string(), getpid());
    if (fs::exists(whole)) fs::rename(whole, before);
    fs::rename(partial, whole);
    fs::remove_all(before);
  } catch (const std::exception& error) {
    std::error_code ignored;
    fs::remove_all(partial, ignored);
    fail("{}: cannot be written: {}", folder.string(), error.what());
  }
}

}  // namespace houghstream::teach
