#include <cstring>
#include <filesystem>

#include "pipeline/geometry/mesh.hpp"
#include "tests/fuzz/fuzz_targets.hpp"

// Through to the mesh, so that the library behind the checks is tried too.

namespace houghstream::fuzz {
namespace {

Taken read_ply(ByteView input) {
  return {load_mesh(as_file(input, "mesh.ply")).triangles.size()};
}

Taken read_obj(ByteView input) {
  return {load_mesh(as_file(input, "mesh.obj")).triangles.size()};
}

Taken read_stl(ByteView input) {
  return {load_mesh(as_file(input, "mesh.stl")).triangles.size()};
}

/// Returns the materials of a mesh that is whole.
Taken read_mtl(ByteView input) {
  const std::string materials = std::filesystem::path(as_file(input, "paint.mtl")).filename().string();
  const Bytes mesh =
      bytes_of_text("mtllib " + materials + "\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 2\n");
  return {load_mesh(as_file({mesh.data(), mesh.size()}, "painted.obj")).triangles.size()};
}

Taken read_glb(ByteView input) {
  return {load_mesh(as_file(input, "mesh.glb")).triangles.size()};
}

template <typename Number>
void append(Number number, Bytes& bytes) {
  std::uint8_t part[sizeof number];
  std::memcpy(part, &number, sizeof number);
  bytes.insert(bytes.end(), part, part + sizeof number);
}

std::vector<Bytes> plys() {
  const std::string faces = "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string axes = "property float x\nproperty float y\nproperty float z\n";
  const std::string text = "ply\nformat ascii 1.0\ncomment made\nelement vertex 4\n" + axes +
                           "property uchar red\nproperty uchar green\nproperty uchar blue\n" + faces +
                           "0 0 0 1 2 3\n1 0 0 1 2 3\n1 1 0 1 2 3\n0 1 0 1 2 3\n3 0 1 2\n4 0 1 2 3\n";
  Bytes binary = bytes_of_text("ply\nformat binary_little_endian 1.0\nelement vertex 4\n" + axes + faces);
  for (const float value : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 1.0F, 1.0F, 0.0F, 0.0F, 1.0F, 0.0F})
    append(value, binary);
  for (const int third : {2, 3}) {
    append(std::uint8_t{3}, binary);
    for (const std::int32_t corner : {0, third - 1, third}) append(corner, binary);
  }
  return {bytes_of_text(text), binary};
}

/// Its last vertex is in its last face only, so that every cut can be told.
std::vector<Bytes> objs() {
  return {
      bytes_of_text("o thing\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\nusemtl red\n"
                    "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1\nf 2/1/1 3/1/1 4/1/1\nf -4/1/1 -2/1/1 -1/1/1\n")};
}

std::vector<Bytes> stls() {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1e0 0\nendloop\nendfacet\n";
  Bytes binary(80, ' ');
  append(std::uint32_t{1}, binary);
  for (const float value : {0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 1.0F, 1.0F, 0.0F})
    append(value, binary);
  append(std::uint16_t{0}, binary);
  return {bytes_of_text("solid thing\n" + facet + facet + "endsolid thing\n"), binary};
}

/// The count of triangles in a binary one.
void repair_stl(Bytes& input) {
  constexpr std::size_t kHeader = 84;
  if (input.size() < kHeader || std::memcmp(input.data(), "solid", 5) == 0) return;
  const auto triangles = static_cast<std::uint32_t>((input.size() - kHeader) / 50);
  std::memcpy(input.data() + kHeader - sizeof triangles, &triangles, sizeof triangles);
}

std::vector<Bytes> mtls() {
  return {bytes_of_text("# made\nnewmtl red\nNs 250.0\nKa 1 1 1\nKd 0.8 0 0\nd 1\nillum 2\nnewmtl blue\nKd 0 0 0.8\n")};
}

std::vector<Bytes> glbs() {
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[1,1,1]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],)"
      R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],)"
      R"("buffers":[{"byteLength":42}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  Bytes bytes = bytes_of_text("glTF");
  append(std::uint32_t{2}, bytes);
  append(static_cast<std::uint32_t>(28 + json.size() + 44), bytes);
  append(static_cast<std::uint32_t>(json.size()), bytes);
  for (const char c : "JSON" + json) bytes.push_back(static_cast<std::uint8_t>(c));
  append(std::uint32_t{44}, bytes);
  for (const char c : std::string("BIN\0", 4)) bytes.push_back(static_cast<std::uint8_t>(c));
  for (const float value : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F}) append(value, bytes);
  for (const int corner : {0, 1, 2, 0}) append(static_cast<std::uint16_t>(corner), bytes);
  return {bytes};
}

/// The header's length of the whole, and of the binary chunk at its end.
void repair_glb(Bytes& input) {
  if (input.size() < 20 || std::memcmp(input.data(), "glTF", 4) != 0) return;
  const auto size = static_cast<std::uint32_t>(input.size());
  std::memcpy(input.data() + 8, &size, sizeof size);
  std::uint32_t json = 0;
  std::memcpy(&json, input.data() + 12, sizeof json);
  if (std::uint64_t{28} + json > size) return;
  const std::uint32_t rest = size - 28 - json;
  std::memcpy(input.data() + 20 + json, &rest, sizeof rest);
}

}  // namespace

std::vector<FuzzTarget> mesh_targets() {
  return {{"ply",
           read_ply,
           plys,
           nullptr,
           {"element ", "property ", "list ", "vertex_index", "end_header", "double ", "short "},
           1024,
           kAnyDamage},
          // It states no counts: a face may become a group ('f' to 'g'), or a part of the name in the line before it.
          {"obj",
           read_obj,
           objs,
           nullptr,
           {"v ", "vt ", "vn ", "f ", "mtllib ", "usemtl ", "//", "\\\n", "nan"},
           1024,
           {true, 1}},
          {"stl",
           read_stl,
           stls,
           repair_stl,
           {"facet normal ", "outer loop\n", "endloop\n", "solid ", "endsolid\n"},
           1024,
           kAnyDamage},
          {"mtl",
           read_mtl,
           mtls,
           nullptr,
           {"newmtl ", "Kd ", "map_Kd ", "bump ", "-bm 1 ", "-s 1 1 1 ", "-clamp on ", "illum ", "Tf ", "d "},
           512},
          {"glb",
           read_glb,
           glbs,
           repair_glb,
           {"\"children\"", "\"matrix\"", "\"mode\"", "\"TEXCOORD_0\"", "\"byteStride\"", "\"images\"", "\"textures\""},
           2048,
           {true, {}}}};
}

}  // namespace houghstream::fuzz
