#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// Whether the file of a mesh is whole, asked before a library that believes its counts reads it. For mesh_io.cpp only.

namespace houghstream {

/// PLY 1.0 (Turk 1994), text or binary: a whole header, as many entries of each element as it states, nothing behind
/// them, faces of three corners or more that are vertices. Throws InputError, naming `source` and the place.
void check_ply(std::string_view bytes, const std::string& source);

/// Wavefront OBJ with polygons: known words, numbers that are numbers, faces whose corners exist, no face cut short.
/// The format states no counts; a file that was cut shows in its last line, and in vertices at its end that belong to
/// no face. Throws InputError, naming `source` and the line.
void check_obj(std::string_view bytes, const std::string& source);

/// The materials of an OBJ: known words with as many numbers as they take, textures with a file, all of a material that
/// has a name. Throws InputError, naming `source` and the line.
void check_mtl(std::string_view bytes, const std::string& source);

/// The same of each file of materials that an OBJ names; one that is missing is none.
void check_materials(std::string_view obj, const std::filesystem::path& file);

/// glTF 2.0 as text or GLB (ISO/IEC 12113): lengths that add up, buffers that are there, views and accessors within
/// them, indices that exist, nodes that are a tree. Throws InputError, naming the file and the part.
void check_gltf(std::string_view bytes, const std::filesystem::path& file);

}  // namespace houghstream
