#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>

namespace houghstream::teach {

/// Renames an object everywhere in the store; all else stays as it is. Throws InputError where no object has the old
/// name, or another one has the new.
void rename_in_store(const std::filesystem::path& folder, const std::string& old_name, const std::string& new_name);

/// Parses "x,y,z" or "x,y,z,qw,qx,qy,qz": metres and a unit quaternion, T_object_frame. Throws InputError.
Eigen::Isometry3d parse_frame_place(const std::string& text);

/// Names a frame on an object of the store, moves the one of this name, or, without a pose, takes it away. Throws
/// InputError for an object or a frame that is not there, and for a name that is none.
void set_frame_in_store(const std::filesystem::path& folder, const std::string& object_name,
                        const std::string& frame_name, const std::optional<Eigen::Isometry3d>& T_object_frame);

}  // namespace houghstream::teach
