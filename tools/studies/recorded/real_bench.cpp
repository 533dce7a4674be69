#include "tools/studies/recorded/real_bench.hpp"

#include <algorithm>
#include <cmath>

#include "detector/stages.hpp"
#include "drivers/files/frame_folder.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/studies/recorded/pose_sheets.hpp"

namespace houghstream {
namespace {

/// Returns the strongest result with a pose, else the strongest; null where the object was not detected.
const ObjectPose* pose_of(const ObjectPoses& poses, const std::string& class_name) {
  const ObjectPose* best = nullptr;
  for (const ObjectPose& pose : poses.poses) {
    if (pose.class_name != class_name) continue;
    if (best == nullptr || (!best->T_camera_object && pose.T_camera_object)) best = &pose;
  }
  return best;
}

bool lies_in(const Detection& detection, const std::vector<DrawnBox>& boxes) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const DrawnBox& box) {
    return box.object == detection.class_name && box_iou(detection.box_px, box.box_px) >= 0.5F;
  });
}

/// The poses that were found for true detections and not believed.
ObjectPoses withheld_poses(const Detections& detections, const ObjectPoses& poses, const ObjectPoses& unchecked,
                           const std::vector<DrawnBox>& boxes) {
  ObjectPoses withheld;
  for (std::size_t i = 0; i < poses.poses.size(); ++i) {
    if (!poses.poses[i].T_camera_object && lies_in(detections.detections[i], boxes))
      withheld.poses.push_back(unchecked.poses[i]);
  }
  return withheld;
}

const std::vector<DrawnBox>& boxes_of(const std::string& frame, const std::vector<DrawnFrame>& drawn) {
  const auto at = std::find_if(drawn.begin(), drawn.end(), [&](const DrawnFrame& f) { return f.name == frame; });
  require(at != drawn.end(), "frame {}: no entry among the {} frames with drawn boxes", frame, drawn.size());
  return at->boxes;
}

ComparedFrame compare(const std::string& frame, const ReferencePose& reference, const ObjectPoses& poses,
                      const ComparedObject& object) {
  ComparedFrame out;
  out.frame = frame;
  out.reliable = reference.reliable;
  const ObjectPose* pose = pose_of(poses, object.class_name);
  out.outcome = pose == nullptr ? "not detected" : to_string(pose->status);
  if (pose == nullptr || !pose->T_camera_object) return out;
  // The poses are compared in the frame of the views, since that of the scan has its origin far from the object.
  const Eigen::Isometry3d T_reference = reference.T_camera_object * object.scan.alignment.T_target_source.inverse();
  out.difference = compare_poses(*pose->T_camera_object, T_reference, object.symmetries);
  return out;
}

std::string title_of(const std::string& frame, const ComparedFrame* compared) {
  if (compared == nullptr || !compared->difference) return frame;
  return fmt::format("{}: {:.1f} mm {:.1f} deg{}", frame, 1e3 * compared->difference->shift_m,
                     compared->difference->angle_deg, compared->reliable ? "" : " (unreliable reference)");
}

OrderedJson to_json(const ComparedFrame& frame) {
  OrderedJson out = {{"frame", frame.frame}, {"reliable", frame.reliable}, {"outcome", frame.outcome}};
  out["mm"] = frame.difference ? OrderedJson(1e3 * frame.difference->shift_m) : OrderedJson(nullptr);
  out["deg"] = frame.difference ? OrderedJson(frame.difference->angle_deg) : OrderedJson(nullptr);
  return out;
}

}  // namespace

RealBench run_real_bench(const std::filesystem::path& scenes, const DrawnBoxes& drawn, const BenchedMethod& method,
                         const ComparedObject& object) {
  RealBench bench;
  DetectorWorkspace workspace;
  std::int64_t utime = 0;
  for (const FrameFiles& pair : list_frame_pairs(scenes)) {
    const RgbdFrame frame = read_frame_pair(pair, drawn.camera, ++utime);
    const Detections detections = method.detector.detect(frame, workspace);
    const ObjectPoses poses = method.estimator.estimate(frame, detections);
    const ObjectPoses withheld = withheld_poses(detections, poses, method.unchecked.estimate(frame, detections),
                                                boxes_of(pair.name, drawn.frames));
    for (const ObjectPose& pose : poses.poses) bench.poses += pose.T_camera_object ? 1 : 0;
    const auto reference = object.references.find(pair.name);
    const bool is_compared = reference != object.references.end();
    if (is_compared) bench.compared.push_back(compare(pair.name, reference->second, poses, object));
    const std::string title = title_of(pair.name, is_compared ? &bench.compared.back() : nullptr);
    bench.images.push_back(draw_poses(frame, poses, withheld, method.models, title));
    bench.images.push_back(paint_models(frame, poses, method.models));
  }
  require(bench.compared.size() == object.references.size(), "{}: {} of the {} frames with reference poses",
          scenes.string(), bench.compared.size(), object.references.size());
  return bench;
}

OrderedJson to_json(const RealBench& bench, const ComparedObject& object) {
  const AgreementSummary summary = summarise(bench.compared);
  OrderedJson out = {{"object", object.class_name},
                     {"poses", bench.poses},
                     {"frames", summary.frames},
                     {"with_pose", summary.with_pose},
                     {"within_5mm_5deg", summary.within_5mm_5deg}};
  out["median_mm"] = summary.median ? OrderedJson(1e3 * summary.median->shift_m) : OrderedJson(nullptr);
  out["median_deg"] = summary.median ? OrderedJson(summary.median->angle_deg) : OrderedJson(nullptr);
  out["symmetries"] = object.symmetries.continuous.size() + object.symmetries.discrete.size();
  const MeshAlignment& alignment = object.scan.alignment;
  const Eigen::Quaterniond q(alignment.T_target_source.linear());
  const Eigen::Vector3d t = 1e3 * alignment.T_target_source.translation();
  out["alignment"] = {{"rms_mm", finite_or_null(1e3 * alignment.rms_m)},
                      {"next_rms_mm", finite_or_null(1e3 * alignment.next_rms_m)},
                      {"wxyz", {q.w(), q.x(), q.y(), q.z()}},
                      {"t_mm", {t.x(), t.y(), t.z()}}};
  out["per_frame"] = OrderedJson::array();
  for (const ComparedFrame& frame : bench.compared) out["per_frame"].push_back(to_json(frame));
  return out;
}

}  // namespace houghstream
