#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/json_names.hpp"
#include "pipeline/geometry/mesh_check.hpp"

namespace houghstream {
namespace {

using Json = nlohmann::json;

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// One asset whose parts are looked at.
class GltfCheck {
 public:
  GltfCheck(std::string_view bytes, const std::filesystem::path& file) : file_(file), source_(file.string()) {
    text_ = bytes;
    if (bytes.substr(0, 4) == "glTF") take_chunks(bytes);
    json_ = parse_json(text_, source_);
    require(json_.is_object(), "{}: no glTF, or cut: its JSON does not end", source_);
  }

  void check() {
    const Json asset = json_.value("asset", Json::object());
    const bool is_two = asset.is_object() && asset.contains("version") && asset["version"].is_string() &&
                        asset["version"].get<std::string>().rfind("2.", 0) == 0;
    require(is_two, "{}: no glTF of version 2", source_);
    for (const Json& buffer : list("buffers")) check_buffer(buffer);
    for (const Json& view : list("bufferViews")) check_view(view);
    for (const Json& accessor : list("accessors")) check_accessor(accessor);
    for (const Json& mesh : list("meshes")) check_mesh(mesh);
    check_nodes();
    check_looks();
    for (const char* moving : {"animations", "skins"})
      require(list(moving).empty(), "{}: holds {}, expected an object that keeps its shape", source_, moving);
  }

 private:
  void take_chunks(std::string_view bytes) {
    constexpr std::size_t kHeader = 12;
    constexpr std::size_t kChunkHeader = 8;
    require(bytes.size() >= kHeader + kChunkHeader && little_endian(bytes, 4) == 2, "{}: no GLB of version 2, or cut",
            source_);
    require(little_endian(bytes, 8) == bytes.size(), "{}: {} bytes, its header states {}: cut or damaged", source_,
            bytes.size(), little_endian(bytes, 8));
    for (std::size_t at = kHeader; at < bytes.size();) {
      require(bytes.size() - at >= kChunkHeader && little_endian(bytes, at) <= bytes.size() - at - kChunkHeader,
              "{}: a chunk that reaches over the end", source_);
      const std::string_view chunk = bytes.substr(at + kChunkHeader, little_endian(bytes, at));
      const std::string_view type = bytes.substr(at + 4, 4);
      require(at != kHeader || type == "JSON", "{}: does not begin with JSON", source_);
      const bool is_binary = type == std::string_view("BIN\0", 4);
      require(!is_binary || !has_binary_, "{}: two chunks of numbers, expected one", source_);
      if (at == kHeader) text_ = chunk;
      if (is_binary) binary_ = chunk;
      has_binary_ = has_binary_ || is_binary;
      at += kChunkHeader + chunk.size();
    }
  }

  const Json& list(const char* name) const {
    static const Json kNone = Json::array();
    if (!json_.contains(name)) return kNone;
    require(json_[name].is_array(), "{}: {} are no list", source_, name);
    return json_[name];
  }

  /// A whole number that is not negative; `otherwise` where there is none, -1 = it must be there.
  std::int64_t number(const Json& entry, const char* name, std::int64_t otherwise = -1) const {
    require(entry.is_object(), "{}: an entry beside '{}' is no object", source_, name);
    if (!entry.contains(name) && otherwise >= 0) return otherwise;
    const Json value = entry.value(name, Json());
    const bool good = value.is_number_integer() && value.is_number_unsigned() && value <= 0xFFFFFFFFU;
    require(good, "{}: '{}' is {}, expected a whole number", source_, name, value.dump(-1, ' ', false, kReplace));
    return value.get<std::int64_t>();
  }

  std::int64_t index(const Json& entry, const char* name, const char* of) const {
    const std::int64_t at = number(entry, name);
    require(at < static_cast<std::int64_t>(list(of).size()), "{}: '{}' names {} of {} {}", source_, name, at,
            list(of).size(), of);
    return at;
  }

  void check_buffer(const Json& buffer) {
    const std::int64_t bytes = number(buffer, "byteLength");
    std::int64_t there = static_cast<std::int64_t>(binary_.size());
    const std::string uri = buffer.contains("uri") && buffer["uri"].is_string() ? buffer["uri"].get<std::string>() : "";
    if (uri.rfind("data:", 0) == 0) {
      const std::size_t comma = uri.find(',');
      there = comma == std::string::npos ? 0 : static_cast<std::int64_t>((uri.size() - comma - 1) / 4 * 3);
    } else if (!uri.empty()) {
      std::error_code error;
      const std::filesystem::path place = file_.parent_path() / uri;
      there = std::filesystem::is_regular_file(place, error)
                  ? static_cast<std::int64_t>(std::filesystem::file_size(place, error))
                  : 0;
    } else {
      require(has_binary_ && &buffer == &list("buffers").front(), "{}: a buffer that is nowhere", source_);
    }
    require(bytes >= 1 && bytes <= there, "{}: a buffer of {} bytes, {} are there", source_, bytes, there);
  }

  void check_view(const Json& view) {
    const Json& buffer = list("buffers")[static_cast<std::size_t>(index(view, "buffer", "buffers"))];
    const std::int64_t end = number(view, "byteOffset", 0) + number(view, "byteLength");
    const std::int64_t stride = number(view, "byteStride", 0);
    require(end <= number(buffer, "byteLength"), "{}: a view up to byte {} of a buffer of {}", source_, end,
            number(buffer, "byteLength"));
    require(stride == 0 || (stride >= 4 && stride <= 252), "{}: a stride of {}, expected 4 to 252", source_, stride);
  }

  static std::int64_t component_bytes(std::int64_t type) {
    return type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : type == 5125 || type == 5126 ? 4 : 0;
  }

  static std::int64_t components(const Json& accessor) {
    const Json type = accessor.value("type", Json());
    const std::string name = type.is_string() ? type.get<std::string>() : "";
    return name == "SCALAR"                   ? 1
           : name == "VEC2"                   ? 2
           : name == "VEC3"                   ? 3
           : name == "VEC4" || name == "MAT2" ? 4
           : name == "MAT3"                   ? 9
           : name == "MAT4"                   ? 16
                                              : 0;
  }

  void check_accessor(const Json& accessor) {
    require(accessor.is_object() && !accessor.contains("sparse"), "{}: sparse numbers, expected all of them", source_);
    const Json& view = list("bufferViews")[static_cast<std::size_t>(index(accessor, "bufferView", "bufferViews"))];
    const std::int64_t size = component_bytes(number(accessor, "componentType")) * components(accessor);
    const std::int64_t count = number(accessor, "count");
    const std::int64_t stride = number(view, "byteStride", 0) == 0 ? size : number(view, "byteStride", 0);
    require(size > 0 && count > 0 && stride >= size, "{}: {} entries of {} bytes every {}, expected some", source_,
            count, size, stride);
    const std::int64_t end = number(accessor, "byteOffset", 0) + stride * (count - 1) + size;
    require(end <= number(view, "byteLength"), "{}: entries up to byte {} of a view of {}", source_, end,
            number(view, "byteLength"));
  }

  const Json& accessor(std::int64_t at) const { return list("accessors")[static_cast<std::size_t>(at)]; }

  void check_primitive(const Json& primitive) {
    require(primitive.is_object() && primitive.value("attributes", Json()).is_object() &&
                !primitive["attributes"].empty() && !primitive.contains("targets"),
            "{}: a part of a mesh without numbers, or one that changes its shape", source_);
    const Json& attributes = primitive["attributes"];
    const Json& positions = accessor(index(attributes, "POSITION", "accessors"));
    const std::int64_t vertices = number(positions, "count");
    require(components(positions) == 3 && number(positions, "componentType") == 5126,
            "{}: positions are not three floats each", source_);
    for (const auto& [name, value] : attributes.items()) {
      const Json& other = accessor(index(attributes, name.c_str(), "accessors"));
      const std::int64_t width = components(other);
      require(number(other, "count") == vertices, "{}: {} entries {} for {} vertices", source_, number(other, "count"),
              name, vertices);
      require(name != "NORMAL" || width == 3, "{}: normals of {} numbers", source_, width);
      require(name.rfind("TEXCOORD", 0) != 0 || width == 2, "{}: texture coordinates of {} numbers", source_, width);
      require(name.rfind("COLOR", 0) != 0 || width == 3 || width == 4, "{}: colours of {} numbers", source_, width);
    }
    require(number(primitive, "mode", 4) <= 6, "{}: a part of kind {}, expected 0 to 6", source_,
            number(primitive, "mode", 4));
    if (primitive.contains("material")) index(primitive, "material", "materials");
    if (primitive.contains("indices")) check_indices(accessor(index(primitive, "indices", "accessors")), vertices);
  }

  /// Which vertices they are is checked where they have been read: a buffer may lie in another file.
  void check_indices(const Json& indices, std::int64_t vertices) {
    const std::int64_t type = number(indices, "componentType");
    require(components(indices) == 1 && (type == 5121 || type == 5123 || type == 5125),
            "{}: corners that are no whole numbers", source_);
    const Json& view = list("bufferViews")[static_cast<std::size_t>(number(indices, "bufferView"))];
    const Json& buffer = list("buffers")[static_cast<std::size_t>(number(view, "buffer"))];
    if (buffer.contains("uri")) return;
    const auto size = static_cast<std::size_t>(component_bytes(type));
    const auto stride = static_cast<std::size_t>(number(view, "byteStride", static_cast<std::int64_t>(size)));
    std::size_t at = static_cast<std::size_t>(number(view, "byteOffset", 0) + number(indices, "byteOffset", 0));
    for (std::int64_t left = number(indices, "count"); left > 0; --left, at += stride) {
      std::uint32_t vertex = 0;
      std::memcpy(&vertex, binary_.data() + at, size);
      require(vertex < vertices, "{}: a face names vertex {}, expected one of {}", source_, vertex, vertices);
    }
  }

  void check_mesh(const Json& mesh) {
    require(mesh.is_object() && mesh.value("primitives", Json()).is_array(), "{}: a mesh without parts", source_);
    for (const Json& primitive : mesh["primitives"]) check_primitive(primitive);
  }

  /// Every node has one parent at most, so that walking down them comes to an end.
  void check_nodes() {
    std::set<std::int64_t> children;
    const std::size_t nodes = list("nodes").size();
    for (std::size_t n = 0; n < nodes; ++n) {
      const Json& node = list("nodes")[n];
      require(node.is_object(), "{}: a node that is no object", source_);
      if (node.contains("mesh")) index(node, "mesh", "meshes");
      for (const auto& [name, count] : {std::pair{"matrix", 16}, {"rotation", 4}, {"scale", 3}, {"translation", 3}})
        check_numbers(node, name, static_cast<std::size_t>(count));
      for (const Json& child : node.value("children", Json::array())) {
        const bool good = child.is_number_unsigned() && child < nodes && child > n;
        const bool other = child.is_number_unsigned() && child < nodes && child < n;
        require((good || other) && children.insert(child.get<std::int64_t>()).second,
                "{}: node {} has a child that is none, or has two parents", source_, n);
      }
    }
    check_depth(children);
    for (const Json& scene : list("scenes")) {
      require(scene.is_object(), "{}: a scene that is no object", source_);
      for (const Json& root : scene.value("nodes", Json::array())) {
        require(root.is_number_unsigned() && root < nodes && children.count(root.get<std::int64_t>()) == 0,
                "{}: a scene begins with a node that is none, or is another one's child", source_);
      }
    }
    if (json_.contains("scene")) index(json_, "scene", "scenes");
  }

  /// With one parent each, nodes that no root reaches go round in circles.
  void check_depth(const std::set<std::int64_t>& children) const {
    constexpr int kDeepest = 200;
    std::vector<std::size_t> level;
    const Json& nodes = list("nodes");
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (children.count(static_cast<std::int64_t>(n)) == 0) level.push_back(n);
    }
    std::size_t reached = level.size();
    for (int depth = 0; !level.empty(); ++depth) {
      require(depth < kDeepest, "{}: nodes below one another more than {} times", source_, kDeepest);
      std::vector<std::size_t> below;
      for (const std::size_t n : level) {
        for (const Json& child : nodes[n].value("children", Json::array())) below.push_back(child.get<std::size_t>());
      }
      reached += below.size();
      level = std::move(below);
    }
    require(reached == nodes.size(), "{}: nodes that are their own children", source_);
  }

  void check_numbers(const Json& entry, const char* name, std::size_t count) const {
    if (!entry.contains(name)) return;
    const Json& numbers = entry[name];
    require(numbers.is_array() && numbers.size() == count &&
                std::all_of(numbers.begin(), numbers.end(), [](const Json& value) { return value.is_number(); }),
            "{}: a node's {} is not {} numbers", source_, name, count);
  }

  /// Materials, textures and images.
  void check_looks() {
    for (const Json& image : list("images")) {
      require(image.is_object(), "{}: an image that is no object", source_);
      if (image.contains("bufferView")) index(image, "bufferView", "bufferViews");
      require(image.contains("bufferView") || (image.contains("uri") && image["uri"].is_string()),
              "{}: an image that is nowhere", source_);
    }
    for (const Json& texture : list("textures")) {
      require(texture.is_object(), "{}: a texture that is no object", source_);
      if (texture.contains("source")) index(texture, "source", "images");
      if (texture.contains("sampler")) index(texture, "sampler", "samplers");
    }
    for (const Json& material : list("materials")) {
      require(material.is_object(), "{}: a material that is no object", source_);
      check_material(material);
    }
  }

  /// Every {"index": N} within a material is a texture's.
  void check_material(const Json& part) {
    if (part.is_object() && part.contains("index")) index(part, "index", "textures");
    if (!part.is_structured()) return;
    for (const auto& entry : part) check_material(entry);
  }

  static constexpr Json::error_handler_t kReplace = Json::error_handler_t::replace;

  std::filesystem::path file_;
  std::string source_;
  std::string_view text_;
  std::string_view binary_;
  bool has_binary_ = false;
  Json json_;
};

}  // namespace

void check_gltf(std::string_view bytes, const std::filesystem::path& file) {
  try {
    GltfCheck(bytes, file).check();
  } catch (const nlohmann::json::exception& error) {
    fail("{}: damaged glTF: {}", file.string(), error.what());
  }
}

}  // namespace houghstream
