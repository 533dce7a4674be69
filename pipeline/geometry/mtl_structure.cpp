#include <array>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/geometry/mesh_text.hpp"
#include "pipeline/geometry/mesh_check.hpp"

namespace houghstream {
namespace {

using namespace mesh_text;

template <std::size_t Count>
bool is_one_of(std::string_view word, const std::array<std::string_view, Count>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// A remark may follow.
void check_mtl_numbers(const Words& words, std::size_t most, const std::string& where) {
  const auto end = std::find_if(words.begin(), words.end(), [](std::string_view word) { return word.front() == '#'; });
  const auto count = static_cast<std::size_t>(end - words.begin()) - 1;
  require(count >= 1 && count <= most, "{}: {} numbers, expected 1 to {}", where, count, most);
  for (std::size_t i = 1; i <= count; ++i) {
    const std::optional<double> number = number_of<double>(words[i]);
    require(number && std::isfinite(*number), "{}: '{}', expected a number", where, shown(words[i]));
  }
}

/// Options with so many words each, then a file's name.
void check_mtl_texture(const Words& words, const std::string& where) {
  static constexpr std::array<std::string_view, 9> kOfOne = {"-blendu", "-blendv", "-boost",  "-bm",     "-cc",
                                                             "-clamp",  "-type",   "-texres", "-imfchan"};
  static constexpr std::array<std::string_view, 3> kOfThree = {"-o", "-s", "-t"};
  std::size_t at = 1;
  while (at < words.size() && words[at].front() == '-') {
    const std::size_t follow = is_one_of(words[at], kOfOne) ? 1 : is_one_of(words[at], kOfThree) ? 3 : 2;
    require(follow != 2 || words[at] == "-mm", "{}: '{}', expected an option of a texture, or its file", where,
            shown(words[at]));
    at += 1 + follow;
  }
  require(at < words.size(), "{}: a texture without a file", where);
}

bool is_mtl_texture(std::string_view word) {
  static constexpr std::array<std::string_view, 6> kOthers = {"bump", "disp", "decal", "refl", "norm", "map_bump"};
  return word.substr(0, 4) == "map_" || is_one_of(word, kOthers);
}

/// Words that the library does not know are passed over by it too.
void check_mtl_line(const Words& words, bool& has_material, const std::string& where) {
  static constexpr std::array<std::string_view, 5> kColours = {"Ka", "Kd", "Ks", "Ke", "Tf"};
  static constexpr std::array<std::string_view, 12> kNumbers = {"Ns", "Ni", "d",  "Tr", "illum", "sharpness",
                                                                "Pr", "Pm", "Ps", "Pc", "Pcr",   "aniso"};
  if (words[0] == "newmtl") {
    require(words.size() >= 2, "{}: a material without a name", where);
    has_material = true;
    return;
  }
  const bool is_colour = is_one_of(words[0], kColours);
  const bool is_number = is_one_of(words[0], kNumbers) || words[0] == "anisor";
  if (!is_colour && !is_number && !is_mtl_texture(words[0])) return;
  require(has_material, "{}: stands before the first 'newmtl'", where);
  if (is_mtl_texture(words[0])) return check_mtl_texture(words, where);
  check_mtl_numbers(words, is_colour ? 3 : 1, where);
}

/// What the library looks for: what stands behind the word in its line, and where that is not there, the OBJ's own
/// name.
std::vector<std::filesystem::path> material_files(std::string_view obj, const std::filesystem::path& file) {
  const std::string folder = file.has_parent_path() ? file.parent_path().string() + "/" : std::string();
  std::vector<std::filesystem::path> found;
  Lines lines(obj);
  while (const std::optional<std::string_view> line = lines.next()) {
    const Words words = split(*line);
    if (words.empty() || words[0] != "mtllib") continue;
    require(line->back() != '\\', "{}: line {}: a file of materials whose name goes on in the next line", file.string(),
            lines.number());
    if (found.empty()) found.push_back(std::filesystem::path(file).replace_extension("mtl"));
    if (words.size() < 2) continue;
    std::string name(words[1].data(), line->data() + line->size());
    name = name.substr(0, name.find('\f'));
    found.emplace_back(folder + name);  // also of a name that begins with /
  }
  return found;
}

}  // namespace

void check_mtl(std::string_view bytes, const std::string& source) {
  constexpr std::size_t kMaxLineLength = 1000;
  require(bytes.find('\0') == std::string_view::npos, "{}: holds a byte 0, expected text", source);
  bool has_material = false;
  Lines lines(bytes);
  while (const std::optional<std::string_view> line = lines.next()) {
    require(line->size() <= kMaxLineLength, "{}: line {} of {} bytes, expected at most {}", source, lines.number(),
            line->size(), kMaxLineLength);
    const Words words = split(*line);
    if (!words.empty())
      check_mtl_line(words, has_material, fmt::format("{}: line {} '{}'", source, lines.number(), shown(*line)));
  }
  // The library refuses what is shorter than a material with a name, without closing the file.
  constexpr std::size_t kMinDuration = std::string_view("newmtl a").size();
  require(bytes.empty() || bytes.size() >= kMinDuration, "{}: {} bytes, expected none, or {} and more", source,
          bytes.size(), kMinDuration);
}

void check_materials(std::string_view obj, const std::filesystem::path& file) {
  for (const std::filesystem::path& materials : material_files(obj, file)) {
    std::error_code error;
    if (!std::filesystem::exists(materials, error)) continue;
    check_mtl(read_file(materials, "an OBJ's materials"), materials.string());
  }
}

}  // namespace houghstream
