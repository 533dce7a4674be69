#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/studies/colours/strange_cameras.hpp"

// This study measures what cameras of strange colours cost, and how much of it the map of a camera's colours recovers:
// rendered calibration scenes with the objects of a store, seen through each of the cameras.

namespace houghstream::colours {

struct StudySettings {
  int rooms = 6;  ///< two frames each
  int cameras = 24;
  std::uint64_t seed = 1;
  int threads = 2;
  std::string pairs;  ///< CSV file with the colours observed at the poses; empty: none
};

/// Holds the figures of one or several cameras.
struct Figures {
  int objects = 0;
  double auc = 0.0;       ///< area under the curve of the detections' scores, mean over the classes
  double pose_auc = 0.0;  ///< the same of the poses' qualities: average precision over all objects
  int published = 0;
  int right = 0;          ///< correct ones of the published poses
  double ece = 0.0;       ///< calibration error of the qualities
  double off = 0.0;       ///< distance of correct poses' measured chroma from the expected, median, CIE a*b*
  double conflict = 0.0;  ///< fraction of pairs of a correct and an incorrect pose that chroma distinguishes
};

/// Holds one row of the table.
struct Row {
  std::string name;
  Figures as_taught;  ///< colours are not learnt
  Figures in_frame;   ///< colours are learnt in each frame
  Figures in_stream;  ///< colours are learnt in each frame and from the earlier frames
};

/// Studies the plain camera, then each strange one, then the mean over those.
std::vector<Row> study_cameras(const std::filesystem::path& store, const StudySettings& settings);

std::string to_table(const std::vector<Row>& rows);

}  // namespace houghstream::colours
