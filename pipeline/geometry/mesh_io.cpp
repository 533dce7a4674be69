#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/texture.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/image_decoding.hpp"
#include "pipeline/geometry/material_merge.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/mesh_check.hpp"

namespace houghstream {
namespace {

std::uint8_t to_byte(float value) {
  const float fraction = value > 0.0F ? std::min(value, 1.0F) : 0.0F;  // NaN too
  return static_cast<std::uint8_t>(std::lround(fraction * 255.0F));
}

/// Converts a colour: glTF states colours in linear light, the other formats as a screen shows them (IEC 61966-2-1).
std::uint8_t to_byte(float value, bool is_linear) {
  if (!is_linear) return to_byte(value);
  return to_byte(value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1.0F / 2.4F) - 0.055F);
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool is_gltf(const std::filesystem::path& file) {
  return lower_extension(file) == ".glb" || lower_extension(file) == ".gltf";
}

bool is_stl(const std::filesystem::path& file) {
  return lower_extension(file) == ".stl";
}

/// Checks that the file is whole: Assimp trusts its contents, and cut or damaged ones make it loop for ever, end the
/// process, or return a part.
void require_whole(const std::filesystem::path& file) {
  const std::string bytes = read_file(file, "a PLY, OBJ, STL or glTF mesh");
  if (lower_extension(file) == ".ply") return check_ply(bytes, file.string());
  if (lower_extension(file) == ".obj") return check_obj(bytes, file);
  if (is_stl(file)) return check_stl(bytes, file.string());
  require(is_gltf(file), "{}: expected a file .ply, .obj, .stl, .glb or .gltf", file.string());
  check_gltf(bytes, file.string());
}

/// Later steps trust these counts: corners may refer to any position of a buffer, and triangulation of a polygon takes
/// time cubic in its corners.
void check_faces(const aiMesh& part, const std::string& file) {
  constexpr unsigned kMaxCorners = 1024;
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    require(face.mNumIndices >= 1 && face.mNumIndices <= kMaxCorners, "{}: face {} with {} corners, expected 1 to {}",
            file, i, face.mNumIndices, kMaxCorners);
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      require(face.mIndices[k] < part.mNumVertices, "{}: face {} names vertex {} of {}", file, i, face.mIndices[k],
              part.mNumVertices);
    }
  }
}

/// The scene as the file has it, then in triangles. It belongs to the importer.
const aiScene& read_scene(const std::filesystem::path& file, Assimp::Importer& importer) {
  const auto require_scene = [&](const aiScene* scene) {
    if (scene != nullptr && (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) == 0U) return;
    std::string words = importer.GetErrorString();
    words.erase(words.find_last_not_of(" .") + 1);
    fail("{}: {}, expected a PLY, OBJ, STL or glTF mesh with triangles", file.string(), words);
  };
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  require_scene(scene);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) check_faces(*scene->mMeshes[i], file.string());
  // An STL states a normal for each triangle, often 0 0 0; without them corners that meet become one.
  if (is_stl(file)) {
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS);
    require_scene(importer.ApplyPostProcessing(aiProcess_RemoveComponent));
  }
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
                                       aiProcess_GenSmoothNormals | aiProcess_PreTransformVertices);
  require_scene(scene);
  return *scene;
}

void append_vertices(const aiMesh& part, double unit_m, const std::filesystem::path& file, Mesh& mesh) {
  const bool is_linear = is_gltf(file);
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    const Eigen::Vector3f vertex = (Eigen::Vector3d(p.x, p.y, p.z) * unit_m).cast<float>();
    require(vertex.allFinite(), "{}: vertex {} is ({}, {}, {}), expected finite coordinates", file.string(), i, p.x,
            p.y, p.z);
    mesh.vertices.push_back(vertex);
    mesh.normals.emplace_back(part.mNormals[i].x, part.mNormals[i].y, part.mNormals[i].z);
    if (part.HasVertexColors(0)) {
      const aiColor4D& c = part.mColors[0][i];
      mesh.colours.emplace_back(to_byte(c.b, is_linear), to_byte(c.g, is_linear), to_byte(c.r, is_linear));
    }
    const aiVector3D uv = part.HasTextureCoords(0) ? part.mTextureCoords[0][i] : aiVector3D();
    mesh.uvs.emplace_back(uv.x, 1.0F - uv.y);  // files count v upwards
  }
}

void append_triangles(const aiMesh& part, std::uint32_t first_vertex, const std::string& file, Mesh& mesh) {
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    require(face.mNumIndices == 3, "{}: face {} with {} corners, expected 3", file, i, face.mNumIndices);
    std::array<std::uint32_t, 3> triangle{};
    for (unsigned k = 0; k < 3; ++k) {
      require(face.mIndices[k] < part.mNumVertices, "{}: face {} names vertex {} of {}", file, i, face.mIndices[k],
              part.mNumVertices);
      triangle[k] = first_vertex + face.mIndices[k];
    }
    mesh.triangles.push_back(triangle);
  }
}

/// A texture that the file itself holds, CV_8UC3 BGR. Throws InputError where it cannot be decoded.
cv::Mat decode_texture(const aiTexture& texture, const std::string& where) {
  cv::Mat image;
  if (texture.mHeight == 0) {  // an image file of mWidth bytes
    image = decode_image(reinterpret_cast<const std::uint8_t*>(texture.pcData), texture.mWidth, cv::IMREAD_COLOR);
  } else {
    const cv::Mat bgra(static_cast<int>(texture.mHeight), static_cast<int>(texture.mWidth), CV_8UC4, texture.pcData);
    cv::cvtColor(bgra, image, cv::COLOR_BGRA2BGR);
  }
  require(!image.empty(), "{}: cannot be decoded, expected a PNG or JPEG", where);
  return image;
}

/// The texture that gives a material its colour.
std::string texture_name(const aiMaterial& material) {
  aiString name;
  for (const aiTextureType type : {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR}) {
    if (material.GetTexture(type, 0, &name) == aiReturn_SUCCESS) return name.C_Str();
  }
  return "";
}

/// Returns the appearance of a part, from its material.
MeshPart describe_part(const aiScene& scene, const aiMesh& part, std::size_t first_vertex,
                       const std::filesystem::path& file) {
  const aiMaterial& material = *scene.mMaterials[part.mMaterialIndex];
  MeshPart out;
  out.first_vertex = first_vertex;
  out.vertices = part.mNumVertices;
  out.has_uvs = part.HasTextureCoords(0);
  std::string texture = texture_name(material);
  if (const aiTexture* embedded = texture.empty() ? nullptr : scene.GetEmbeddedTexture(texture.c_str())) {
    out.texture = file / texture;  // a name for it: "FILE.glb/*0"
    out.image = decode_texture(*embedded, out.texture.string());
  } else if (!texture.empty()) {
    std::replace(texture.begin(), texture.end(), '\\', '/');  // separators of files made on Windows
    out.texture = file.parent_path() / texture;
  }
  aiColor3D c;
  // Where the file names no material, the library makes up a grey one: with this name, for a PLY without a name, and
  // for glTF with no colour either.
  const std::string name = material.GetName().C_Str();
  const bool is_linear = is_gltf(file);
  const bool is_made_up = name == AI_DEFAULT_MATERIAL_NAME || (name.empty() && !is_linear);
  out.has_colour = !is_made_up && material.Get(AI_MATKEY_COLOR_DIFFUSE, c) == aiReturn_SUCCESS;
  if (out.has_colour) out.colour = cv::Vec3b(to_byte(c.b, is_linear), to_byte(c.g, is_linear), to_byte(c.r, is_linear));
  return out;
}

/// Selects the optional columns of a PLY.
struct PlyParts {
  bool normals, colours, texture;
};

PlyParts parts_of(const Mesh& mesh) {
  return {mesh.normals.size() == mesh.vertices.size(), mesh.colours.size() == mesh.vertices.size(),
          !mesh.texture.empty() && mesh.uvs.size() == mesh.vertices.size()};
}

std::string ply_header(const Mesh& mesh, const PlyParts& parts, const std::string& texture_name) {
  std::string text = "ply\nformat ascii 1.0\n";
  if (parts.texture) text += "comment TextureFile " + texture_name + "\n";
  text += fmt::format("element vertex {}\n", mesh.vertices.size());
  text += "property float x\nproperty float y\nproperty float z\n";
  if (parts.normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (parts.texture) text += "property float texture_u\nproperty float texture_v\n";
  if (parts.colours) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  text += fmt::format("element face {}\n", mesh.triangles.size());
  return text + "property list uchar int vertex_indices\nend_header\n";
}

void append_ply_vertices(const Mesh& mesh, const PlyParts& parts, std::string& text) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f vertex_mm = mesh.vertices[i] * 1e3F;
    text += fmt::format("{} {} {}", vertex_mm.x(), vertex_mm.y(), vertex_mm.z());
    if (parts.normals) text += fmt::format(" {} {} {}", mesh.normals[i].x(), mesh.normals[i].y(), mesh.normals[i].z());
    if (parts.texture) text += fmt::format(" {} {}", mesh.uvs[i].x(), 1.0F - mesh.uvs[i].y());
    if (parts.colours) text += fmt::format(" {} {} {}", mesh.colours[i][2], mesh.colours[i][1], mesh.colours[i][0]);
    text += '\n';
  }
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& file, double unit_m) {
  require_whole(file);
  Assimp::Importer importer;
  const aiScene& scene = read_scene(file, importer);
  Mesh mesh;
  std::vector<MeshPart> parts;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const auto first_vertex = static_cast<std::uint32_t>(mesh.vertices.size());
    const aiMesh& part = *scene.mMeshes[i];
    parts.push_back(describe_part(scene, part, first_vertex, file));
    append_vertices(part, unit_m, file, mesh);
    append_triangles(part, first_vertex, file.string(), mesh);
  }
  require(!mesh.triangles.empty(), "{}: no triangles, expected a surface", file.string());
  paint(parts, file, mesh);
  return mesh;
}

void save_ply(const Mesh& mesh, const std::filesystem::path& file) {
  const PlyParts parts = parts_of(mesh);
  const std::filesystem::path texture_file = std::filesystem::path(file).replace_extension(".png");
  std::string text = ply_header(mesh, parts, texture_file.filename().string());
  append_ply_vertices(mesh, parts, text);
  for (const auto& t : mesh.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  if (parts.texture) {  // before the mesh that names it
    std::vector<unsigned char> png;
    require(cv::imencode(".png", mesh.texture, png), "{}: cannot be written as PNG", texture_file.string());
    write_file_atomically(texture_file, {reinterpret_cast<const char*>(png.data()), png.size()});
  }
  write_file_atomically(file, text);
}

}  // namespace houghstream
