#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// A frame that somebody has named on an object: a handle, a grasp.
struct ObjectFrame {
  std::string name;
  Eigen::Isometry3d T_object_frame = Eigen::Isometry3d::Identity();  ///< pose in the object, metres
};

/// A named frame of an object of the world, where it is.
struct PlacedObjectFrame {
  std::string name;
  Eigen::Isometry3d T_world_frame = Eigen::Isometry3d::Identity();  ///< pose in the world, metres
};

/// The room that an object of the world takes up.
struct ObjectPlacement {
  std::int64_t track_id = 0;  ///< from 1
  std::string class_name;
  /// Middle of the box about its mesh, which lies along the axes of the object's frame, metres.
  Eigen::Isometry3d T_world_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d box_size = Eigen::Vector3d::Zero();  ///< along the box' own axes, metres
  std::vector<PlacedObjectFrame> frames;               ///< by name
};

/// The room that the objects of the world take up after a frame: of those whose model is known, by track_id.
struct ObjectPlacements {
  FrameId frame;      ///< after which it is so
  std::string world;  ///< as in WorldObjects
  int world_number = 1;
  std::vector<ObjectPlacement> objects;

  /// Returns the object with this number; null where it is not placed.
  const ObjectPlacement* find(std::int64_t track_id) const {
    for (const ObjectPlacement& object : objects) {
      if (object.track_id == track_id) return &object;
    }
    return nullptr;
  }
};

}  // namespace houghstream
