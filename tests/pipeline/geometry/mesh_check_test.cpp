#include "pipeline/geometry/mesh_check.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

constexpr int kRings = 6;
constexpr int kSectors = 8;

/// Returns a closed ball of 50 mm: 42 vertices, 80 triangles.
Mesh ball() {
  Mesh mesh;
  mesh.vertices.emplace_back(0.0F, 0.0F, -0.05F);
  for (int ring = 1; ring < kRings; ++ring) {
    const float polar = 3.14159265F * (static_cast<float>(ring) / kRings - 0.5F);
    for (int sector = 0; sector < kSectors; ++sector) {
      const float around = 2.0F * 3.14159265F * static_cast<float>(sector) / kSectors;
      mesh.vertices.emplace_back(0.05F * std::cos(polar) * std::cos(around), 0.05F * std::cos(polar) * std::sin(around),
                                 0.05F * std::sin(polar));
    }
  }
  mesh.vertices.emplace_back(0.0F, 0.0F, 0.05F);
  const auto at = [](int ring, int sector) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * kSectors + sector % kSectors);
  };
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (int s = 0; s < kSectors; ++s) mesh.triangles.push_back({0, at(1, s + 1), at(1, s)});
  for (int ring = 1; ring + 1 < kRings; ++ring) {
    for (int s = 0; s < kSectors; ++s) {
      mesh.triangles.push_back({at(ring, s), at(ring, s + 1), at(ring + 1, s)});
      mesh.triangles.push_back({at(ring, s + 1), at(ring + 1, s + 1), at(ring + 1, s)});
    }
  }
  for (int s = 0; s < kSectors; ++s) mesh.triangles.push_back({at(kRings - 1, s), at(kRings - 1, s + 1), last});
  return mesh;
}

template <typename Number>
void append(Number number, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string text_ply() {
  const fs::path file = fs::temp_directory_path() / "mesh_check_test_text.ply";
  save_ply(ball(), file);
  return read_file(file, "a mesh");
}

std::string binary_ply() {
  const Mesh mesh = ball();
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  for (const Eigen::Vector3f& v : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) append(1e3F * v[axis], bytes);
  }
  for (const auto& t : mesh.triangles) {
    append(std::uint8_t{3}, bytes);
    for (const std::uint32_t corner : t) append(static_cast<std::int32_t>(corner), bytes);
  }
  return bytes;
}

std::string obj() {
  const Mesh mesh = ball();
  std::string text = "# a ball\no ball\n";
  for (const Eigen::Vector3f& v : mesh.vertices)
    text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", 1e3F * v.x(), 1e3F * v.y(), 1e3F * v.z());
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

std::string glb() {
  const Mesh mesh = ball();
  std::string binary;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) append(v[axis], binary);
  }
  const std::size_t vertices = binary.size();
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t) append(static_cast<std::uint16_t>(corner), binary);
  }
  std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
      R"({{"bufferView":1,"componentType":5123,"count":{},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("buffers":[{{"byteLength":{}}}]}})",
      mesh.vertices.size(), 3 * mesh.triangles.size(), vertices, vertices, binary.size() - vertices, binary.size());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  append(std::uint32_t{2}, bytes);
  append(static_cast<std::uint32_t>(28 + json.size() + binary.size()), bytes);
  append(static_cast<std::uint32_t>(json.size()), bytes);
  bytes += "JSON" + json;
  append(static_cast<std::uint32_t>(binary.size()), bytes);
  return bytes + std::string("BIN\0", 4) + binary;
}

std::string text_stl() {
  const Mesh mesh = ball();
  std::string text = "solid a ball\n";
  for (const auto& t : mesh.triangles) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const std::uint32_t corner : t) {
      const Eigen::Vector3f v = 1e3F * mesh.vertices[corner];
      text += fmt::format("      vertex {:.6e} {:.6e} {:.6e}\n", v.x(), v.y(), v.z());
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid a ball\n";
}

std::string binary_stl() {
  const Mesh mesh = ball();
  std::string bytes = "solid, as many programs call binary ones too";
  bytes.resize(80, ' ');
  append(static_cast<std::uint32_t>(mesh.triangles.size()), bytes);
  for (const auto& t : mesh.triangles) {
    for (int axis = 0; axis < 3; ++axis) append(0.0F, bytes);
    for (const std::uint32_t corner : t) {
      for (int axis = 0; axis < 3; ++axis) append(1e3F * mesh.vertices[corner][axis], bytes);
    }
    append(std::uint16_t{0}, bytes);
  }
  return bytes;
}

struct Kind {
  const char* ending;
  std::string bytes;
};

std::vector<Kind> kinds() {
  return {{".ply", text_ply()}, {"_binary.ply", binary_ply()}, {".obj", obj()},
          {".stl", text_stl()}, {"_binary.stl", binary_stl()}, {".glb", glb()}};
}

/// Triangles that a file with these bytes gives; nothing where it is refused in one line.
std::optional<std::size_t> triangles_of(const Kind& kind, const std::string& bytes) {
  const fs::path file = fs::temp_directory_path() / (std::string("mesh_check_test") + kind.ending);
  std::ofstream(file, std::ios::binary) << bytes;
  try {
    return load_mesh(file, 1e-3).triangles.size();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return std::nullopt;
  }
}

TEST(MeshCheck, WholeFilesAreRead) {
  for (const Kind& kind : kinds()) EXPECT_EQ(triangles_of(kind, kind.bytes), ball().triangles.size()) << kind.ending;
}

TEST(MeshCheck, CutFilesAreRefused) {
  for (const Kind& kind : kinds()) {
    for (int i = 0; i < 30; ++i) {
      const std::size_t length = kind.bytes.size() * static_cast<std::size_t>(i) / 30;
      EXPECT_EQ(triangles_of(kind, kind.bytes.substr(0, length)), std::nullopt)
          << kind.ending << " cut to " << length << " of " << kind.bytes.size();
    }
    const std::size_t vertices_end = kind.bytes.find("end_header");
    if (vertices_end != std::string::npos) {
      EXPECT_EQ(triangles_of(kind, kind.bytes.substr(0, vertices_end - 5)), std::nullopt) << "in its header";
    }
  }
}

TEST(MeshCheck, APlyThatEndsBehindAnyOfItsLinesIsRefused) {
  const std::string whole = text_ply();
  for (std::size_t end = whole.find('\n') + 1; end < whole.size(); end = whole.find('\n', end) + 1)
    EXPECT_THROW(check_ply(whole.substr(0, end), "cut.ply"), InputError) << end << " of " << whole.size();
}

// An OBJ states no counts: behind a face, with every vertex in one, it may be whole.
TEST(MeshCheck, AnObjThatEndsBehindALineIsRefusedUnlessEveryVertexHasAFace) {
  const std::string whole = obj();
  const std::size_t last_vertex_used = whole.find(" 42\n") + 4;
  for (std::size_t end = whole.find('\n') + 1; end < whole.size(); end = whole.find('\n', end) + 1) {
    const bool is_refused = !error_of([&] { check_obj(whole.substr(0, end), "cut.obj"); }).empty();
    // Before its first vertex it has none that lacks a face; that it has no face is seen where it is read.
    EXPECT_EQ(is_refused, end < last_vertex_used && end > whole.find("v ")) << end << " of " << whole.size();
  }
}

TEST(MeshCheck, DamagedFilesAreRefusedOrAsLarge) {
  for (const Kind& kind : kinds()) {
    std::mt19937 random(7);
    int refused = 0;
    for (int i = 0; i < 100; ++i) {
      std::string bytes = kind.bytes;
      bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
      const std::optional<std::size_t> triangles = triangles_of(kind, bytes);
      if (!triangles) ++refused;
      // Corners that have become the same leave a face without area, which is no triangle.
      if (triangles) {
        EXPECT_GE(*triangles + 2, ball().triangles.size()) << kind.ending << ", flip " << i;
      }
    }
    // Of a binary STL only the count says something of the rest.
    EXPECT_GT(refused + (kind.ending == std::string("_binary.stl") ? 1 : 0), 0) << kind.ending;
  }
}

TEST(MeshCheck, WhatIsWrittenByOthersIsRead) {
  EXPECT_NO_THROW(
      check_obj("v 1 2 3\r\nv +1.5e-3 0 0\r\nv 0 1 0\r\nvt 0 1\r\ng top\r\nusemtl red\r\ns off\r\n"
                "f -3/1 -2/1 -1/1\r\n",
                "of Windows"));
  EXPECT_NO_THROW(check_obj("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 \\\n 2 3\n", "continued"));
  const std::string tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4";
  EXPECT_NO_THROW(check_obj(tetrahedron, "closed, its last line without an end"));
  EXPECT_THROW(check_obj(tetrahedron.substr(0, tetrahedron.size() - 8), "cut behind a line"), InputError);
  EXPECT_NO_THROW(
      check_ply("ply\r\nformat ascii 1.0\r\ncomment made\r\nelement vertex 3\r\nproperty double x\r\n"
                "property double y\r\nproperty double z\r\nelement face 1\r\n"
                "property list uint8 uint32 vertex_index\r\nend_header\r\n0 0 0\r\n1 0 0\r\n0 nan 0\r\n"
                "3 0 1 2\r\n",
                "of Windows"));
}

TEST(MeshCheck, AnStlHasItsCornersJoinedAndNormalsOfItsSurface) {
  const fs::path folder = fresh_folder("mesh_check_stl");
  for (const std::string& bytes : {text_stl(), binary_stl()}) {
    std::ofstream(folder / "ball.STL", std::ios::binary) << bytes;
    const Mesh read = load_mesh(folder / "ball.STL", 1e-3);
    EXPECT_EQ(read.vertices.size(), ball().vertices.size());
    ASSERT_EQ(read.normals.size(), read.vertices.size());
    for (std::size_t i = 0; i < read.vertices.size(); ++i)
      EXPECT_GT(std::abs(read.normals[i].dot(read.vertices[i].normalized())), 0.9F) << "none is stated in the file";
    EXPECT_TRUE(read.colours.empty());
  }
}

TEST(MeshCheck, AnStlIsWholeInItsLines) {
  const std::string facet =
      "facet normal 0 0 1\r\nouter loop\r\nvertex 0 0 0\r\nvertex 1 0 0\r\nvertex 0 +1.5E-3 "
      "0\r\nendloop\r\nendfacet\r\n";
  EXPECT_NO_THROW(check_stl("solid\r\n" + facet + facet + "endsolid\r\nsolid of two\n" + facet + "endsolid", "of two"));
  const auto without = [&](const std::string& line) {
    std::string text = "solid\n" + facet + "endsolid\n";
    return text.erase(text.find(line), line.size());
  };
  for (const char* line : {"facet normal 0 0 1\r\n", "outer loop\r\n", "vertex 1 0 0\r\n", "endloop\r\n",
                           "endfacet\r\n", "endsolid\n", "0 0 1", "+1.5E-3"})
    EXPECT_THROW(check_stl(without(line), "without.stl"), InputError) << line;
  for (const char* bad : {"", "solid", "SOLID\nendsolid\n", "solid of a facet\nendsolid\n", "solid\nendsolid\nmore\n"})
    EXPECT_THROW(check_stl(bad, "bad.stl"), InputError) << bad;
  std::string bytes = binary_stl();
  EXPECT_NO_THROW(check_stl(bytes, "binary.stl"));
  EXPECT_THROW(check_stl(bytes + " ", "longer.stl"), InputError);
  bytes[80] = static_cast<char>(bytes[80] - 1);
  EXPECT_THROW(check_stl(bytes, "fewer.stl"), InputError);
}

TEST(MeshCheck, NodesThatGoRoundAreRefused) {
  const std::string head = R"({"asset":{"version":"2.0"},"nodes":[)";
  EXPECT_THROW(check_gltf(head + R"({"children":[1]},{"children":[0]}]})", "round.gltf"), InputError);
  EXPECT_THROW(check_gltf(head + R"({"children":[0]}]})", "itself.gltf"), InputError);
  EXPECT_THROW(check_gltf(std::string(100000, '['), "deep.gltf"), InputError);
  EXPECT_NO_THROW(check_gltf(head + R"({"children":[1]},{}]})", "one.gltf"));
}

// Readers differ: one takes the first value, another the last.
TEST(MeshCheck, NamesThatStandTwiceAreRefused) {
  EXPECT_THROW(check_gltf(R"({"asset":{"version":"2.0"},"accessors":[],"accessors":[]})", "twice.gltf"), InputError);
  EXPECT_THROW(check_gltf(R"({"asset":{"version":"2.0","version":"2.0"}})", "within.gltf"), InputError);
  EXPECT_NO_THROW(check_gltf(R"({"asset":{"version":"2.0"},"nodes":[{"name":"a"},{"name":"b"}]})", "once.gltf"));
  std::string bytes = glb();
  const std::string more = std::string("\4\0\0\0BIN\0", 8) + "more";
  bytes += more;
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(&bytes[8], &size, sizeof size);
  EXPECT_THROW(check_gltf(bytes, "two_bodies.glb"), InputError);
}

TEST(MeshCheck, EntriesOfNoBytesAreRefused) {
  std::string bytes = binary_ply();
  bytes.insert(bytes.find("end_header"), "element nothing 2147483647\n");
  EXPECT_THROW(check_ply(bytes, "nothing.ply"), InputError);
}

TEST(MeshCheck, ListsOfLessThanNothingAreRefused) {
  std::string bytes = binary_ply();
  bytes.insert(bytes.find("end_header"), "element more 1\nproperty list char uchar values\n");
  EXPECT_NO_THROW(check_ply(bytes + std::string("\1\0", 2), "one.ply"));
  EXPECT_THROW(check_ply(bytes + "\xFF" + std::string(255, '\0'), "minus_one.ply"), InputError);
}

// The library takes a body that begins like a line's end for what is left of its header, and all numbers move by a
// byte.
TEST(MeshCheck, ABodyThatBeginsWithALinesEndIsRefused) {
  std::string bytes = binary_ply();
  bytes[bytes.find("end_header") + 11] = '\n';
  EXPECT_THROW(check_ply(bytes, "line_end.ply"), InputError);
}

TEST(MeshCheck, APolygonOfThousandsOfCornersIsRefused) {
  std::string text;
  std::string face = "f";
  for (int i = 0; i < 2000; ++i) {
    const double angle = 2.0 * M_PI * i / 2000;
    text += fmt::format("v {:.6f} {:.6f} 0\n", 1e3 * std::cos(angle), 1e3 * std::sin(angle));
    face += fmt::format(" {}", i + 1);
  }
  const fs::path file = fs::temp_directory_path() / "mesh_check_test_round.obj";
  std::ofstream(file) << text << face << "\n";
  EXPECT_THROW(load_mesh(file), InputError);
}

TEST(MeshCheck, MaterialsAreWholeToo) {
  EXPECT_NO_THROW(
      check_mtl("# made\r\nnewmtl red\r\nNs 250.0 # shiny\r\nKa 1 1 1\r\nKd 0.8 0 0\r\nd 1\r\nillum 2\r\n"
                "map_Kd -s 1 1 1 -bm 1.0 red paint.png\r\nmap_Bump bump.png\r\nof_others 5\r\n",
                "of Windows"));
  EXPECT_NO_THROW(check_mtl("", "empty"));
  for (const char* bad : {"Kd 1 0 0\n", "newmtl\n", "newmtl a\nKd\n", "newmtl a\nKd 1 x 0\n", "newmtl a\nKd 1 nan 0\n",
                          "newmtl a\nKd 1 1 1 1\n", "newmtl a\nNs\n", "newmtl a\nmap_Kd\n", "newmtl a\nmap_Kd -bm 1\n",
                          "newmtl a\nmap_Kd -unknown 1 a.png\n"})
    EXPECT_THROW(check_mtl(bad, "bad.mtl"), InputError) << bad;
  EXPECT_NO_THROW(check_mtl("newmtl a", "shortest.mtl"));
  EXPECT_THROW(check_mtl("# made\n", "short.mtl"), InputError);
  EXPECT_THROW(check_mtl("newmtl a\n# " + std::string(2000, 'x'), "long.mtl"), InputError);
  EXPECT_THROW(check_mtl(std::string("newmtl a\0", 9), "zero.mtl"), InputError);
}

TEST(MeshCheck, DamagedMaterialsOfAMeshAreRefused) {
  const fs::path folder = fs::temp_directory_path();
  const fs::path file = folder / "mesh_check_test_painted.obj";
  const auto say = [&](const std::string& name, const std::string& materials) {
    std::ofstream(file) << name << "\n" << obj();
    std::ofstream(folder / "mesh_check_test_painted.mtl") << materials;
  };
  say("mtllib mesh_check_test_painted.mtl", "newmtl red\nKd 1 0 0\n");
  EXPECT_NO_THROW(load_mesh(file));
  say("mtllib mesh_check_test_painted.mtl", "Kd 1 0 0\n");
  EXPECT_THROW(load_mesh(file), InputError);
  say("mtllib not_there.mtl", "Kd 1 0 0\n");
  EXPECT_THROW(load_mesh(file), InputError) << "the library takes the one of its own name";
  say("mtllib not_there.mtl \\", "newmtl red\n");
  EXPECT_THROW(load_mesh(file), InputError);
}

}  // namespace
}  // namespace houghstream
