// Prints where the objects are in the frame of a robot's base, with nothing but LCM and the message types:
//   poses_in_base [X Y Z ROLL PITCH YAW]      the camera in the base's frame: metres, degrees
#include <Eigen/Geometry>
#include <cstdio>
#include <cstdlib>
#include <houghstream/object_poses_t.hpp>
#include <lcm/lcm-cpp.hpp>

struct Printer {
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();

  void print(const lcm::ReceiveBuffer*, const std::string&, const houghstream::object_poses_t* message) {
    for (const houghstream::object_pose_t& pose : message->poses) {
      if (pose.status != houghstream::object_pose_t::VALID) continue;  // why there is none, or not a sure one
      const Eigen::Vector3d p = T_base_camera * Eigen::Vector3d(pose.trans[0], pose.trans[1], pose.trans[2]);
      const Eigen::Quaterniond q = Eigen::Quaterniond(T_base_camera.linear()) *
                                   Eigen::Quaterniond(pose.quat[0], pose.quat[1], pose.quat[2], pose.quat[3]);
      std::printf("%-20s at %.3f %.3f %.3f m, quaternion %.3f %.3f %.3f %.3f, quality %.2f\n", pose.class_name.c_str(),
                  p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), pose.quality);
    }
    std::fflush(stdout);
  }
};

int main(int argc, char** argv) {
  Printer printer;
  if (argc == 7) {
    double v[6];
    for (int i = 0; i < 6; ++i) v[i] = std::atof(argv[i + 1]) * (i < 3 ? 1.0 : 3.14159265358979 / 180.0);
    printer.T_base_camera.translation() << v[0], v[1], v[2];
    printer.T_base_camera.linear() =
        (Eigen::AngleAxisd(v[5], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(v[4], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(v[3], Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
  }
  lcm::LCM bus;  // $LCM_DEFAULT_URL
  if (!bus.good()) return 1;
  // The newest poses, not the oldest of LCM's queue of 30.
  bus.subscribe("HOUGHSTREAM_POSES", &Printer::print, &printer)->setQueueCapacity(1);
  while (bus.handle() == 0) {
  }
}
