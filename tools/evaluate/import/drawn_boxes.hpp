#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/types/camera.hpp"

namespace houghstream {

struct DrawnBox {
  std::string object;
  cv::Rect box_px;
};

struct DrawnFrame {
  std::string name;  ///< name of NAME_color.png and NAME_depth.png
  std::vector<DrawnBox> boxes;
};

/// Boxes that a person has drawn around the objects of a folder of frames.
struct DrawnBoxes {
  Camera camera;
  std::vector<DrawnFrame> frames;
};

/// Reads {"image_size": [w,h], "camera": {fx,fy,cx,cy}, "frames": [{"frame": NAME, "objects": [{"object": NAME,
/// "bbox_xyxy": [x0,y0,x1,y1]}]}]}; pixels. Throws InputError, also for a box outside the image and where there are no
/// frames.
DrawnBoxes read_drawn_boxes(const std::filesystem::path& file);

/// Reads the list "frames" of such a file. Throws InputError, naming `source`.
std::vector<DrawnFrame> parse_drawn_frames(const nlohmann::json& frames, const Camera& camera,
                                           const std::string& source);

}  // namespace houghstream
