// Finds the objects of a store in one image, without LCM:
//   find_in_images STORE COLOUR DEPTH FX,FY,CX,CY      depth: 16 bits, millimetres, registered to colour
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "tools/finder/object_finder.hpp"

static cv::Mat read_image(const char* file, int flags) {
  cv::Mat image = cv::imread(file, flags);
  if (image.empty()) throw std::runtime_error(std::string(file) + ": found no image");
  return image;
}

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "find_in_images: expected STORE COLOUR DEPTH FX,FY,CX,CY\n");
    return 1;
  }
  try {
    houghstream::RgbdFrame frame;
    frame.colour = read_image(argv[2], cv::IMREAD_COLOR);
    frame.depth = houghstream::depth_from_millimetres(read_image(argv[3], cv::IMREAD_UNCHANGED));
    frame.camera.width = frame.colour.cols;
    frame.camera.height = frame.colour.rows;
    std::sscanf(argv[4], "%lf,%lf,%lf,%lf", &frame.camera.fx, &frame.camera.fy, &frame.camera.cx, &frame.camera.cy);
    houghstream::ObjectFinder finder(argv[1]);
    const houghstream::FoundObjects found = finder.find(frame);
    for (std::size_t i = 0; i < found.detections.detections.size(); ++i) {
      const houghstream::ObjectPose& pose = found.poses.poses[i];
      if (!houghstream::is_reported(found.detections.detections[i], &pose)) continue;
      std::printf("%-20s score %.2f, ", pose.class_name.c_str(), pose.detection_score);
      if (!pose.T_camera_object) {
        std::printf("%s\n", houghstream::to_string(pose.status));
        continue;
      }
      const Eigen::Vector3d p = pose.T_camera_object->translation();
      std::printf("at %.3f %.3f %.3f m, quality %.2f\n", p.x(), p.y(), p.z(), pose.quality);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "find_in_images: %s\n", error.what());
    return 1;
  }
}
