#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// Validates a mesh file before a library reads it that trusts its counts: truncated or damaged files would make it loop
// forever, end the process, or return a part of the mesh. Errors that the library detects are left to it; corners are
// compared with the vertices once they have been read (mesh_io.cpp). All functions throw InputError that names the file
// and the place.

namespace houghstream {

/// Checks PLY 1.0 (Turk 1994), text or binary: a whole header, as many entries of each element as it states, nothing
/// behind them, faces of three corners or more.
void check_ply(std::string_view bytes, const std::string& source);

/// Checks Wavefront OBJ with polygons: known words, valid numbers, faces whose corners exist, no face cut short; and
/// the files of materials that it names, where they exist. The format states no counts; a file that was cut shows in
/// its last line, and in vertices at its end that belong to no face.
void check_obj(std::string_view bytes, const std::filesystem::path& file);

/// Checks STL, text or binary: of a binary one the length that its count of triangles states, of a text its lines in
/// their order, with whole numbers of corners and an end.
void check_stl(std::string_view bytes, const std::string& source);

/// Checks the materials of an OBJ: known words with as many numbers as they take, textures with a file, all within a
/// material that has a name.
void check_mtl(std::string_view bytes, const std::string& source);

/// Checks glTF 2.0 as text or GLB (ISO/IEC 12113): lengths that add up, views and accessors within their buffers,
/// indices that exist, nodes that are a tree.
void check_gltf(std::string_view bytes, const std::string& source);

}  // namespace houghstream
