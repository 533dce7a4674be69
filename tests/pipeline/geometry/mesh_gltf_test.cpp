#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

void append_number(std::uint32_t number, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// Writes the container of glTF 2.0, section 4.4: header, JSON chunk, binary chunk.
void write_glb(std::string json, std::string binary, const fs::path& file) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  append_number(2, bytes);
  append_number(static_cast<std::uint32_t>(28 + json.size() + binary.size()), bytes);
  append_number(static_cast<std::uint32_t>(json.size()), bytes);
  bytes += "JSON" + json;
  append_number(static_cast<std::uint32_t>(binary.size()), bytes);
  bytes += std::string("BIN\0", 4) + binary;
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Returns the bytes of a triangle, 0.2 m along x and y, with texture coordinates and an image of 4 x 2 pixels: left
/// red, right blue.
std::string triangle_bytes(std::size_t& image_bytes) {
  const std::vector<float> numbers = {0, 0, 0, 0.2F, 0, 0, 0, 0.2F, 0, 0.1F, 0.25F, 0.9F, 0.25F, 0.1F, 0.75F};
  std::string binary(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
  cv::Mat image(2, 4, CV_8UC3, cv::Scalar(0, 0, 255));
  image.colRange(2, 4).setTo(cv::Scalar(255, 0, 0));
  std::vector<std::uint8_t> png;
  cv::imencode(".png", image, png);
  binary.append(png.begin(), png.end());
  image_bytes = png.size();
  return binary;
}

/// `material` as glTF writes one, or "" for none.
fs::path write_triangle(const std::string& name, const std::string& material, double scale = 1.0) {
  std::size_t image_bytes = 0;
  const std::string binary = triangle_bytes(image_bytes);
  const std::string use = material.empty() ? "" : R"(,"material":0)";
  const std::string materials = material.empty() ? "" : R"(,"materials":[)" + material + "]";
  const std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[)" +
      fmt::format("{0},{0},{0}", scale) +
      R"(]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1})" + use +
      R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0.2,0.2,0]},)"
      R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],"bufferViews":[{"buffer":0,"byteOffset":0,)"
      R"("byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},{"buffer":0,"byteOffset":60,"byteLength":)" +
      std::to_string(image_bytes) + R"(}],"buffers":[{"byteLength":)" + std::to_string(binary.size()) +
      R"(}],"images":[{"bufferView":2,"mimeType":"image/png"}],"textures":[{"source":0}])" + materials + "}";
  fs::path file = fresh_folder(name) / "part.glb";
  write_glb(json, binary, file);
  return file;
}

TEST(MeshGltf, TheTextureWithinTheFileIsRead) {
  const Mesh mesh =
      load_mesh(write_triangle("texture", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})"), 1.0);
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_NEAR(mesh_diameter(mesh), 0.2 * std::sqrt(2.0), 1e-6);
  ASSERT_EQ(mesh.texture.size(), cv::Size(4, 2));
  EXPECT_EQ(mesh.texture.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 255));
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_right = mesh.vertices[i].x() > 0.1F;
    const bool is_low = mesh.vertices[i].y() > 0.1F;
    EXPECT_NEAR(mesh.uvs[i].x(), is_right ? 0.9F : 0.1F, 1e-5F);
    EXPECT_NEAR(mesh.uvs[i].y(), is_low ? 0.75F : 0.25F, 1e-5F) << "v downwards, as glTF counts it too";
  }
}

TEST(MeshGltf, ABaseColourIsLinearInTheLight) {
  const Mesh mesh =
      load_mesh(write_triangle("colour", R"({"pbrMetallicRoughness":{"baseColorFactor":[1.0,0.2140,0.0,1.0]}})"), 1.0);
  EXPECT_TRUE(mesh.texture.empty());
  ASSERT_EQ(mesh.colours.size(), mesh.vertices.size());
  EXPECT_EQ(mesh.colours[0][2], 255);
  EXPECT_NEAR(mesh.colours[0][1], 127.5, 1.0) << "sRGB of 0.214";
  EXPECT_EQ(mesh.colours[0][0], 0);
}

TEST(MeshGltf, PlacesOfNodesCountAndNoMaterialIsNoColour) {
  const Mesh mesh = load_mesh(write_triangle("scaled", "", 0.5), 1.0);
  EXPECT_NEAR(mesh_diameter(mesh), 0.1 * std::sqrt(2.0), 1e-6);
  EXPECT_TRUE(mesh.texture.empty());
  for (const cv::Vec3b& colour : mesh.colours) EXPECT_EQ(colour, cv::Vec3b(255, 255, 255)) << "glTF's default is white";
}

TEST(MeshGltf, ATextureThatIsNoImageIsRefused) {
  const fs::path file = write_triangle("spoilt", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})");
  std::string bytes;
  {
    std::ifstream in(file, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  const std::size_t png = bytes.find("\x89PNG");
  std::string other = bytes;
  other.replace(png, 4, "none");
  std::string huge = bytes;
  huge[png + 17] = '\xFF';  // the width's second byte
  for (const std::string& spoilt : {other, huge}) {
    std::ofstream(file, std::ios::binary) << spoilt;
    expect_says(error_of([&] { load_mesh(file, 1.0); }), {"part.glb/*0: cannot be decoded"});
  }
}

TEST(MeshGltf, WhatIsNotThereIsRefused) {
  const std::string material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  const fs::path file = write_triangle("not_there", material);
  const std::string whole = read_text(file);
  EXPECT_NO_THROW(load_mesh(file, 1.0));
  for (const char* wrong : {R"("scene":7)", R"("nodes":[7)", R"("mesh":7)", R"("material":7)", R"("index":7)",
                            R"("source":7)", R"("bufferView":7)", R"("version":"1)"}) {
    // All but the last character stands in the file, which is written again with the wrong one.
    const std::string_view text(wrong);
    std::string damaged = whole;
    damaged[whole.rfind(text.substr(0, text.size() - 1)) + text.size() - 1] = text.back();
    write_text(file, damaged);
    EXPECT_THROW(load_mesh(file, 1.0), InputError) << wrong;
  }
}

// The buffers of a GLB are checked in its bytes; here they lie in another file.
TEST(MeshGltf, CornersThatAreNoVerticesAreRefusedBeforeTheyAreUsed) {
  const fs::path folder = fresh_folder("far_corners");
  const std::vector<float> numbers = {0, 0, 0, 0.2F, 0, 0, 0, 0.2F, 0};
  const std::vector<std::uint16_t> corners = {0, 1, 60000};
  std::string binary(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
  binary.append(reinterpret_cast<const char*>(corners.data()), corners.size() * sizeof(std::uint16_t));
  std::ofstream(folder / "part.bin", std::ios::binary) << binary;
  std::ofstream(folder / "part.gltf")
      << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      << R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
      << R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
      << R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],)"
      << R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],)"
      << R"("buffers":[{"uri":"part.bin","byteLength":42}]})";
  EXPECT_THROW(load_mesh(folder / "part.gltf", 1.0), InputError);
}

}  // namespace
}  // namespace houghstream
