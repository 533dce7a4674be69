#include "tools/foxglove/glb_mesh.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/codecs.hpp"

namespace houghstream::foxglove {
namespace {

using Json = nlohmann::ordered_json;

// The numbers of the glTF 2.0 specification.
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

constexpr int kTextureQuality = 90;  // of JPEG

/// Returns a list of this value alone.
Json list_of(Json value) {
  Json list = Json::array();
  list.push_back(std::move(value));
  return list;
}

/// The binary part of the file, and what the JSON part says of it.
class GlbBuffer {
 public:
  /// Appends bytes, and returns the number of their view.
  std::size_t add_view(const void* data, std::size_t size, int target = 0) {
    const std::size_t offset = bytes_.size();
    bytes_.append(static_cast<const char*>(data), size);
    bytes_.resize((bytes_.size() + 3) / 4 * 4);  // each part begins at a multiple of four bytes
    Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    views_.push_back(std::move(view));
    return views_.size() - 1;
  }

  /// Appends a list of float vectors or of indices, and returns the number of its accessor.
  template <typename Element>
  std::size_t add_list(const std::vector<Element>& list, const char* type, const Json& more = Json::object()) {
    const bool is_index = std::string(type) == "SCALAR";
    Json accessor = {{"bufferView", add_view(list.data(), list.size() * sizeof(Element),
                                             is_index ? kElementArrayBuffer : kArrayBuffer)},
                     {"componentType", is_index ? kUnsignedInt : kFloat},
                     {"count", list.size()},
                     {"type", type}};
    accessor.update(more);
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }

  const std::string& bytes() const { return bytes_; }
  const Json& views() const { return views_; }
  const Json& accessors() const { return accessors_; }

 private:
  std::string bytes_;
  Json views_ = Json::array();
  Json accessors_ = Json::array();
};

std::vector<Eigen::Vector3f> with_y_up(const std::vector<Eigen::Vector3f>& vectors) {
  std::vector<Eigen::Vector3f> turned;
  turned.reserve(vectors.size());
  for (const Eigen::Vector3f& v : vectors) turned.emplace_back(v.x(), v.z(), -v.y());
  return turned;
}

/// Returns the linear intensity, 0 to 1, of a value of sRGB: glTF's colours of vertices are linear.
float linear_intensity(unsigned char value) {
  const float share = static_cast<float>(value) / 255.0F;
  return share <= 0.04045F ? share / 12.92F : std::pow((share + 0.055F) / 1.055F, 2.4F);
}

std::vector<Eigen::Vector3f> linear_colours(const std::vector<cv::Vec3b>& bgr) {
  std::vector<Eigen::Vector3f> rgb;
  rgb.reserve(bgr.size());
  for (const cv::Vec3b& c : bgr)
    rgb.emplace_back(linear_intensity(c[2]), linear_intensity(c[1]), linear_intensity(c[0]));
  return rgb;
}

Json bounds_of(const std::vector<Eigen::Vector3f>& vectors) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& v : vectors) box.extend(v);
  const auto list = [](const Eigen::Vector3f& v) { return Json::array({v.x(), v.y(), v.z()}); };
  return {{"min", list(box.min())}, {"max", list(box.max())}};
}

void append_chunk(std::string& file, const char* kind, std::string content, char filling) {
  content.resize((content.size() + 3) / 4 * 4, filling);
  const auto size = static_cast<std::uint32_t>(content.size());
  file.append(reinterpret_cast<const char*>(&size), sizeof size);
  file.append(kind, 4);
  file.append(content);
}

}  // namespace

std::string encode_glb(const Mesh& mesh) {
  require(!mesh.triangles.empty(), "mesh of {} vertices: no triangle", mesh.vertices.size());
  GlbBuffer buffer;
  Json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}}};
  Json gltf = {{"asset", {{"version", "2.0"}, {"generator", "houghstream"}}}};
  const std::vector<Eigen::Vector3f> positions = with_y_up(mesh.vertices);
  Json attributes = {{"POSITION", buffer.add_list(positions, "VEC3", bounds_of(positions))}};
  if (!mesh.normals.empty()) attributes["NORMAL"] = buffer.add_list(with_y_up(mesh.normals), "VEC3");
  if (!mesh.texture.empty() && !mesh.uvs.empty()) {
    const std::vector<std::uint8_t> jpeg = encode_jpeg(mesh.texture, kTextureQuality);
    attributes["TEXCOORD_0"] = buffer.add_list(mesh.uvs, "VEC2");
    gltf["images"] = list_of({{"bufferView", buffer.add_view(jpeg.data(), jpeg.size())}, {"mimeType", "image/jpeg"}});
    gltf["textures"] = list_of({{"source", 0}});
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  } else if (!mesh.colours.empty()) {
    attributes["COLOR_0"] = buffer.add_list(linear_colours(mesh.colours), "VEC3");
  } else {
    material["pbrMetallicRoughness"]["baseColorFactor"] = Json::array({0.5, 0.5, 0.5, 1.0});
  }
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  const std::size_t index_list = buffer.add_list(indices, "SCALAR");
  const Json primitive = {{"attributes", attributes}, {"indices", index_list}, {"material", 0}};
  gltf["materials"] = list_of(material);
  gltf["meshes"] = list_of({{"primitives", list_of(primitive)}});
  gltf["nodes"] = list_of({{"mesh", 0}});
  gltf["scenes"] = list_of({{"nodes", list_of(0)}});
  gltf["scene"] = 0;
  gltf["bufferViews"] = buffer.views();
  gltf["accessors"] = buffer.accessors();
  gltf["buffers"] = list_of({{"byteLength", buffer.bytes().size()}});

  std::string chunks;
  append_chunk(chunks, "JSON", gltf.dump(), ' ');
  append_chunk(chunks, "BIN", buffer.bytes(), '\0');  // with the zero that ends the word
  const std::array<std::uint32_t, 2> head = {2, static_cast<std::uint32_t>(12 + chunks.size())};  // version, length
  return "glTF" + std::string(reinterpret_cast<const char*>(head.data()), sizeof head) + chunks;
}

}  // namespace houghstream::foxglove
