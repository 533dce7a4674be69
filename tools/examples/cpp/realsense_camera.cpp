// Feeds the stream from a RealSense camera, or from a recording of its SDK: realsense_camera [RECORDING.bag]
// The SDKs of Azure Kinect and of Orbbec's cameras do the same by other names: k4a::transformation and ob::Align
// register depth to colour, their calibration holds the colour camera's numbers.
#include <chrono>
#include <cstdio>
#include <librealsense2/rs.hpp>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"

houghstream::RgbdFrame to_frame(const rs2::video_frame& colour, const rs2::depth_frame& depth) {
  const auto pixels = [](const rs2::video_frame& image, int type) {  // the SDK's own, as long as the image lives
    return cv::Mat(image.get_height(), image.get_width(), type, const_cast<void*>(image.get_data()),
                   static_cast<std::size_t>(image.get_stride_in_bytes()));
  };
  houghstream::RgbdFrame frame;
  frame.id.utime =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count();
  frame.colour = pixels(colour, CV_8UC3).clone();
  if (colour.get_profile().format() == RS2_FORMAT_RGB8) cv::cvtColor(frame.colour, frame.colour, cv::COLOR_RGB2BGR);
  const cv::Mat steps = pixels(depth, CV_16UC1);
  steps.convertTo(frame.depth, CV_32F, depth.get_units());  // metres
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN(), steps == 0);
  const rs2_intrinsics lens = colour.get_profile().as<rs2::video_stream_profile>().get_intrinsics();
  frame.camera = {lens.width, lens.height, lens.fx, lens.fy, lens.ppx, lens.ppy};
  return frame;
}

int main(int argc, char** argv) {
  try {
    rs2::config wanted;
    if (argc > 1) {
      wanted.enable_device_from_file(argv[1], false);  // once
    } else {
      wanted.enable_stream(RS2_STREAM_COLOR, 640, 480, RS2_FORMAT_BGR8, 30);
      wanted.enable_stream(RS2_STREAM_DEPTH, 640, 480, RS2_FORMAT_Z16, 30);
    }
    rs2::pipeline camera;
    camera.start(wanted);
    rs2::align to_colour(RS2_STREAM_COLOR);
    houghstream::LcmBus bus("");  // $LCM_DEFAULT_URL
    rs2::frameset taken;
    for (int number = 0; camera.try_wait_for_frames(&taken, 5000); ++number) {
      const rs2::frameset both = to_colour.process(taken);
      const houghstream::RgbdFrame frame = to_frame(both.get_color_frame(), both.get_depth_frame());
      bus.publish(houghstream::channel::kFrame, to_message(frame, houghstream::WireFormat(), number));
    }
    std::fprintf(stderr, "realsense_camera: no frame for 5 s\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "realsense_camera: %s\n", error.what());
    return 1;
  }
}
