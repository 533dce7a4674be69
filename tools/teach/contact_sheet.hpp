#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/types/training_view.hpp"

namespace houghstream::teach {

/// Two dozen of an object's views, spread over all of them, side by side under a title, for a person to look at.
/// CV_8UC3, the same width for every object.
cv::Mat view_picture(const std::vector<TrainingView>& views, const std::string& title);

/// The pictures below one another. Throws InputError where one cannot be read or the sheet not be written.
void write_contact_sheet(const std::vector<std::filesystem::path>& pictures, const std::filesystem::path& sheet);

}  // namespace houghstream::teach
