#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "detector/detector.hpp"
#include "drivers/files/json_file.hpp"
#include "pose/pose_estimator.hpp"
#include "tools/evaluate/import/drawn_boxes.hpp"
#include "tools/studies/recorded/pose_agreement.hpp"
#include "tools/studies/recorded/scan_model.hpp"
#include "tools/view/drawing/overlay.hpp"

namespace houghstream {

/// The object whose poses are compared. Reference poses are those of the scan's frame.
struct ComparedObject {
  std::string class_name;
  ScanModel scan;
  Symmetries symmetries;  ///< symmetries of the scan's shape, object frame of the views
  std::map<std::string, ReferencePose> references;
};

/// Holds the result of a folder of frames.
struct RealBench {
  std::vector<ComparedFrame> compared;  ///< frames with a reference, in natural order
  int poses = 0;                        ///< valid ones, of all classes in all frames
  std::vector<cv::Mat> images;          ///< two of every frame: draw_poses, paint_models
};

/// Refers to the estimator of the poses.
struct BenchedMethod {
  const Detector& detector;
  const PoseEstimator& estimator;
  const PoseEstimator& unchecked;  ///< publishes every pose it finds
  const view::ClassModels& models;
};

/// Detects in every image pair of the folder and estimates poses; of several detections of the compared object the
/// strongest one that has a pose counts. Those that `estimator` withholds are drawn too where the detection lies in a
/// drawn box of its class. Throws InputError, also for references to frames that are not there.
RealBench run_real_bench(const std::filesystem::path& scenes, const DrawnBoxes& drawn, const BenchedMethod& method,
                         const ComparedObject& object);

/// Returns {"object", "poses", "frames", "with_pose", "within_5mm_5deg", "median_mm", "median_deg", "symmetries",
/// "alignment", "per_frame": [{"frame", "reliable", "outcome", "mm", "deg"}]}; null where there is no pose. "poses" is
/// of all classes and frames; the other counts and medians are of reliable references.
OrderedJson to_json(const RealBench& bench, const ComparedObject& object);

}  // namespace houghstream
