#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/store/object_store.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::teach {

/// Describes the symmetries of a shape: "3 half turns", "a spin and a half turn", "a spin but for its handle", "none".
std::string symmetry_words(const ShapeSymmetry& shape);

/// Returns "118 x 83 x 96 mm": sizes along the axes of an object's frame, metres; tenths below 10 mm. "size unknown"
/// for NaN.
std::string size_words(const Eigen::Vector3d& size_m);

/// Returns the caption of an object's views; its size is given along the axes of its frame, metres, which shows a wrong
/// unit.
std::string title_of(const store::StoredObject& object, const Eigen::Vector3d& size_m);

/// Returns two dozen of an object's views, spread over all of them, side by side under a title, for a person to look
/// at. CV_8UC3, the same width for every object.
cv::Mat view_image(const std::vector<TrainingView>& views, const std::string& title);

/// Writes another title above them.
void write_title(const std::string& title, cv::Mat& view_image);

/// Writes the images below one another. Throws InputError where one cannot be read or has another width, or the sheet
/// cannot be written.
void write_contact_sheet(const std::vector<std::filesystem::path>& images, const std::filesystem::path& sheet);

}  // namespace houghstream::teach
