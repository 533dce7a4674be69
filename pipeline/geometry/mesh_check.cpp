#include "pipeline/geometry/mesh_check.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/json_names.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream {
namespace {

using Words = std::vector<std::string_view>;

std::string excerpt(std::string_view text) {
  constexpr std::size_t kMax = 40;
  return printable(text.substr(0, kMax));
}

/// Lines without their ends; takes one off the front.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : text_(text) {}

  std::optional<std::string_view> next() {
    if (text_.empty()) return std::nullopt;
    const std::size_t end = text_.find('\n');
    std::string_view line = text_.substr(0, end);
    is_ended_ = end != std::string_view::npos;
    text_.remove_prefix(is_ended_ ? end + 1 : text_.size());
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number_;
    return line;
  }

  std::int64_t number() const { return number_; }  ///< number of the last line, from 1
  bool is_ended() const { return is_ended_; }      ///< the last line had an end
  std::string_view rest() const { return text_; }

 private:
  std::string_view text_;
  std::int64_t number_ = 0;
  bool is_ended_ = true;
};

Words split_words(std::string_view line) {
  Words words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

/// Returns whether a word occurs in " a list of words ".
bool is_word_of(std::string_view list, std::string_view word) {
  return list.find(fmt::format(" {} ", word)) != std::string_view::npos;
}

template <typename Number>
std::optional<Number> parse_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  Number value{};
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  // A number too small for a double is a zero that was written down exactly.
  const bool is_number = error == std::errc() || error == std::errc::result_out_of_range;
  return is_number && stop == word.data() + word.size() && !word.empty() ? std::optional<Number>(value) : std::nullopt;
}

// ---------------------------------------------------------------- PLY

enum class PlyFormat { kText, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  std::size_t bytes = 0;
  bool is_whole = false;        // an integer
  std::size_t count_bytes = 0;  // bytes of a list's count; 0 = no list
  bool has_signed_count = false;
  std::int64_t min_entries = 0;  // minimum length of a list; 3 for the corners of faces
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;
};

/// Returns the bytes of a number of this type; 0 for an unknown type.
std::size_t ply_type_bytes(std::string_view type) {
  if (is_word_of(" char int8 uchar uint8 ", type)) return 1;
  if (is_word_of(" short int16 ushort uint16 ", type)) return 2;
  if (is_word_of(" int int32 uint uint32 float float32 ", type)) return 4;
  return is_word_of(" double float64 ", type) ? 8 : 0;
}

bool is_fraction_type(std::string_view type) {
  return is_word_of(" float float32 double float64 ", type);
}

/// A file of which the header is read first, then its elements entry by entry.
class PlyCheck {
 public:
  PlyCheck(std::string_view bytes, const std::string& source) : lines_(bytes), source_(source) {}

  void check() {
    read_header();
    for (const PlyElement& element : elements_) check_names(element);
    body_ = lines_.rest();
    require(
        format_ == PlyFormat::kText || body_.empty() || body_.front() != '\n',
        "{}: its first number begins with a byte 10, which the library leaves out; expected text, or a number that is "
        "a little different",
        source_);
    for (const PlyElement& element : elements_) {
      for (std::int64_t item = 0; item < element.count; ++item)
        format_ == PlyFormat::kText ? check_text_item(element, item) : check_binary_item(element, item);
    }
    if (format_ != PlyFormat::kText)
      return require(body_.empty(), "{}: {} bytes lie behind what its header states", source_, body_.size());
    while (const std::optional<std::string_view> line = lines_.next()) {
      require(split_words(*line).empty(), "{}: line {} lies behind what its header states", source_, lines_.number());
    }
  }

 private:
  void read_header() {
    require(lines_.next().value_or("") == "ply", "{}: no PLY file, expected it to begin with 'ply'", source_);
    while (true) {
      const std::optional<std::string_view> line = lines_.next();
      require(line.has_value() && lines_.is_ended(), "{}: cut in its header, expected a line 'end_header'", source_);
      const Words words = split_words(*line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      read_header_line(words, fmt::format("{}: line {} '{}'", source_, lines_.number(), excerpt(*line)));
    }
    require(format_.has_value(), "{}: no format, expected ascii, binary_little_endian or binary_big_endian 1.0",
            source_);
  }

  void read_header_line(const Words& words, const std::string& where) {
    if (words[0] == "format" && words.size() == 3 && words[2] == "1.0" && !format_) {
      if (words[1] == "ascii") format_ = PlyFormat::kText;
      if (words[1] == "binary_little_endian") format_ = PlyFormat::kLittleEndian;
      if (words[1] == "binary_big_endian") format_ = PlyFormat::kBigEndian;
    } else if (words[0] == "element") {
      const std::optional<std::int64_t> count = words.size() == 3 ? parse_number<std::int64_t>(words[2]) : std::nullopt;
      require(count && *count >= 0 && *count <= std::int64_t{0x7FFFFFFF},
              "{}: expected an element's name and its count", where);
      elements_.push_back({std::string(words[1]), *count, {}});
    } else {
      require(words[0] == "property" && !elements_.empty(), "{}: no line of a PLY header", where);
      elements_.back().properties.push_back(parse_property(words, elements_.back().name == "face", where));
    }
  }

  static PlyProperty parse_property(const Words& words, bool is_of_face, const std::string& where) {
    const bool is_list = words.size() == 5 && words[1] == "list";
    const std::string_view type = words.size() == 3 || is_list ? words[words.size() - 2] : "";
    const bool has_count = is_list && ply_type_bytes(words[2]) > 0 && !is_fraction_type(words[2]);
    require(ply_type_bytes(type) > 0 && is_list == has_count,
            "{}: no property of a type that PLY knows; is the header damaged?", where);
    PlyProperty property;
    property.name = words.back();
    property.bytes = ply_type_bytes(type);
    property.is_whole = !is_fraction_type(type);
    if (!is_list) return property;
    property.count_bytes = ply_type_bytes(words[2]);
    property.has_signed_count = words[2].front() != 'u';
    if (is_of_face && is_word_of(" vertex_indices vertex_index ", property.name)) {
      require(property.is_whole, "{}: corners of faces are fractions, expected integers", where);
      property.min_entries = 3;
    }
    return property;
  }

  void check_names(const PlyElement& element) const {
    require(element.name != "tristrips", "{}: holds strips of triangles, expected faces", source_);
    // A file of a few lines may state thousands of millions of entries of no bytes, for which the library allocates
    // memory.
    require(element.count == 0 || !element.properties.empty(), "{}: {} entries '{}' without properties", source_,
            element.count, excerpt(element.name));
    std::set<std::string> names;
    for (const PlyProperty& property : element.properties) {
      require(names.insert(property.name).second, "{}: element {} has '{}' twice; is the header damaged?", source_,
              element.name, excerpt(property.name));
    }
    if (element.name != "vertex") return;
    for (const char* axis : {"x", "y", "z"}) require(names.count(axis) > 0, "{}: vertices without {}", source_, axis);
    const std::array<std::vector<const char*>, 5> kTogether = {
        {{"nx", "ny", "nz"}, {"red", "green", "blue"}, {"texture_u", "texture_v"}, {"s", "t"}, {"u", "v"}}};
    for (const auto& group : kTogether) {
      const auto has =
          std::count_if(group.begin(), group.end(), [&](const char* name) { return names.count(name) > 0; });
      require(has == 0 || has == static_cast<std::ptrdiff_t>(group.size()),
              "{}: vertices with {} of the {} properties {} to {}; is the header damaged?", source_, has, group.size(),
              group.front(), group.back());
    }
  }

  void check_text_item(const PlyElement& element, std::int64_t item) {
    const std::optional<std::string_view> line = lines_.next();
    require(line.has_value() && lines_.is_ended(), "{}: cut in entry {} of {} '{}'", source_, item, element.count,
            excerpt(element.name));
    const Words words = split_words(*line);
    std::size_t at = 0;
    for (const PlyProperty& property : element.properties) {
      std::int64_t count = 1;
      if (property.count_bytes > 0) {
        count = at < words.size() ? parse_number<std::int64_t>(words[at++]).value_or(-1) : -1;
        require(count >= property.min_entries, "{}: line {}: a list of {} entries, expected {} or more", source_,
                lines_.number(), count, property.min_entries);
      }
      require(count <= static_cast<std::int64_t>(words.size() - at), "{}: line {}: {} numbers, expected more", source_,
              lines_.number(), words.size());
      for (; count > 0; --count, ++at) {
        const bool is_number = property.is_whole ? parse_number<std::int64_t>(words[at]).has_value()
                                                 : parse_number<double>(words[at]).has_value();
        require(is_number, "{}: line {}: '{}', expected a number", source_, lines_.number(), excerpt(words[at]));
      }
    }
    require(at == words.size(), "{}: line {}: {} numbers, expected {}", source_, lines_.number(), words.size(), at);
  }

  void check_binary_item(const PlyElement& element, std::int64_t item) {
    for (const PlyProperty& property : element.properties) {
      std::uint64_t bytes = property.bytes;
      if (property.count_bytes > 0) {
        std::uint64_t count = 0;
        const std::string_view digits = take(property.count_bytes, element, item);
        for (std::size_t i = 0; i < digits.size(); ++i) {
          const std::size_t at = format_ == PlyFormat::kBigEndian ? i : digits.size() - 1 - i;
          count = count << 8U | static_cast<std::uint8_t>(digits[at]);
        }
        const bool is_negative = property.has_signed_count && count >> (8 * digits.size() - 1) != 0;
        require(!is_negative && count >= static_cast<std::uint64_t>(property.min_entries),
                "{}: entry {} '{}': a list of {} entries, expected {} or more", source_, item, excerpt(element.name),
                count, property.min_entries);
        bytes *= count;
      }
      take(bytes, element, item);
    }
  }

  std::string_view take(std::uint64_t size, const PlyElement& element, std::int64_t item) {
    require(size <= body_.size(), "{}: cut in entry {} of {} '{}'", source_, item, element.count,
            excerpt(element.name));
    const std::string_view taken = body_.substr(0, size);
    body_.remove_prefix(size);
    return taken;
  }

  TextLines lines_;
  const std::string& source_;
  std::optional<PlyFormat> format_;
  std::vector<PlyElement> elements_;
  std::string_view body_;
};

// ---------------------------------------------------------------- OBJ

/// A file that is read line by line, with what it has given so far.
class ObjCheck {
 public:
  ObjCheck(std::string_view bytes, const std::string& source) : lines_(bytes), source_(source) {}

  void check() {
    std::string joined;  // joined lines that end with a backslash
    while (const std::optional<std::string_view> line = lines_.next()) {
      joined += *line;
      if (!joined.empty() && joined.back() == '\\') {
        joined.back() = ' ';
        continue;
      }
      const Words words = split_words(joined);
      if (!words.empty()) check_line(words, fmt::format("{}: line {} '{}'", source_, lines_.number(), excerpt(joined)));
      joined.clear();
    }
    require(last_used_ == given_[0],
            "{}: vertices {} to {} belong to no face, expected faces up to the last one: is the file cut?", source_,
            last_used_ + 1, given_[0]);
    require(lines_.is_ended() || is_closed(),
            "{}: its last line has no end, and its surface has holes: is the file cut? If it is whole, end that line",
            source_);
  }

 private:
  void check_line(const Words& words, const std::string& where) {
    if (words[0] == "v") return check_numbers(words, {3, 8}, 0, where);  // a weight or a colour may follow
    if (words[0] == "vt") return check_numbers(words, {1, 3}, 1, where);
    if (words[0] == "vn") return check_numbers(words, {3, 3}, 2, where);
    if (words[0] == "f") return check_corners(words, 3, where);
    if (words[0] == "l" || words[0] == "p") return check_corners(words, 1, where);
    const char* kPassedOver = " o g s mg usemtl mtllib lod bevel usemap maplib shadow_obj trace_obj ";
    require(words[0].front() == '#' || is_word_of(kPassedOver, words[0]), "{}: no word of an OBJ file of polygons",
            where);
  }

  void check_numbers(const Words& words, std::pair<std::size_t, std::size_t> range, std::size_t part,
                     const std::string& where) {
    require(words.size() - 1 >= range.first && words.size() - 1 <= range.second, "{}: {} numbers, expected {} to {}",
            where, words.size() - 1, range.first, range.second);
    for (std::size_t i = 1; i < words.size(); ++i)
      require(parse_number<double>(words[i]).has_value(), "{}: '{}', expected a number", where, excerpt(words[i]));
    ++given_[part];
  }

  void check_corners(const Words& words, std::size_t minimum, const std::string& where) {
    require(words.size() > minimum, "{}: {} corners, expected {} or more", where, words.size() - 1, minimum);
    int parts = 0;
    std::vector<std::int64_t> corners(words.size() - 1);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const int found = check_corner(words[i + 1], corners[i], where);
      require(i == 0 || found == parts, "{}: corners of different kinds", where);
      parts = found;
    }
    for (std::size_t i = 0; words[0] == "f" && i < corners.size(); ++i) {
      last_used_ = std::max(last_used_, corners[i]);
      edges_.push_back(std::minmax(corners[i], corners[(i + 1) % corners.size()]));
    }
  }

  /// Returns which of the three numbers of a corner exist: 1 vertex, 2 texture coordinates, 4 normal.
  int check_corner(std::string_view word, std::int64_t& vertex, const std::string& where) const {
    int parts = 0;
    std::size_t part = 0;
    for (; part < given_.size(); ++part) {
      const std::string_view text = word.substr(0, word.find('/'));
      if (!text.empty()) {
        const std::int64_t index = parse_number<std::int64_t>(text).value_or(0);
        const std::int64_t at = index < 0 ? given_[part] + 1 + index : index;
        require(at >= 1 && at <= given_[part], "{}: corner '{}', expected one of the {} given before", where,
                excerpt(text), given_[part]);
        parts |= 1 << part;
        if (part == 0) vertex = at;
      }
      if (text.size() == word.size()) break;
      word.remove_prefix(text.size() + 1);
    }
    require(part < given_.size() && (parts & 1) != 0, "{}: a corner without a vertex", where);
    return parts;
  }

  /// Every edge has a face on both of its sides.
  bool is_closed() {
    std::sort(edges_.begin(), edges_.end());
    for (auto edge = edges_.begin(); edge != edges_.end();) {
      const auto other = std::upper_bound(edge, edges_.end(), *edge);
      if (other - edge < 2) return false;
      edge = other;
    }
    return true;
  }

  TextLines lines_;
  const std::string& source_;
  std::array<std::int64_t, 3> given_ = {};                    // vertices, texture coordinates, normals
  std::int64_t last_used_ = 0;                                // the highest vertex that belongs to a face
  std::vector<std::pair<std::int64_t, std::int64_t>> edges_;  // edges of faces, the smaller vertex first
};

// ---------------------------------------------------------------- MTL

/// A remark may follow.
void check_mtl_numbers(const Words& words, std::size_t maximum, const std::string& where) {
  const auto end = std::find_if(words.begin(), words.end(), [](std::string_view word) { return word.front() == '#'; });
  const auto count = static_cast<std::size_t>(end - words.begin()) - 1;
  require(count >= 1 && count <= maximum, "{}: {} numbers, expected 1 to {}", where, count, maximum);
  for (std::size_t i = 1; i <= count; ++i) {
    const std::optional<double> number = parse_number<double>(words[i]);
    require(number && std::isfinite(*number), "{}: '{}', expected a number", where, excerpt(words[i]));
  }
}

/// Checks options with a fixed number of words each, then a file's name.
void check_mtl_texture(const Words& words, const std::string& where) {
  std::size_t at = 1;
  while (at < words.size() && words[at].front() == '-') {
    const std::size_t follow = is_word_of(" -blendu -blendv -boost -bm -cc -clamp -type -texres -imfchan ", words[at])
                                   ? 1
                               : is_word_of(" -mm ", words[at])      ? 2
                               : is_word_of(" -o -s -t ", words[at]) ? 3
                                                                     : 0;
    require(follow > 0, "{}: '{}', expected an option of a texture, or its file", where, excerpt(words[at]));
    at += 1 + follow;
  }
  require(at < words.size(), "{}: a texture without a file", where);
}

/// Words that the library does not know are passed over by it too.
void check_mtl_line(const Words& words, bool& has_material, const std::string& where) {
  if (words[0] == "newmtl") {
    require(words.size() >= 2, "{}: a material without a name", where);
    has_material = true;
    return;
  }
  const bool is_colour = is_word_of(" Ka Kd Ks Ke Tf ", words[0]);
  const bool is_number = is_word_of(" Ns Ni d Tr illum sharpness Pr Pm Ps Pc Pcr aniso anisor ", words[0]);
  const bool is_texture = words[0].substr(0, 4) == "map_" || is_word_of(" bump disp decal refl norm ", words[0]);
  if (!is_colour && !is_number && !is_texture) return;
  require(has_material, "{}: stands before the first 'newmtl'", where);
  if (is_texture) return check_mtl_texture(words, where);
  check_mtl_numbers(words, is_colour ? 3 : 1, where);
}

/// The library looks for the file named behind the word in its line, and where that is missing, for the OBJ's own name.
std::vector<std::filesystem::path> material_files(std::string_view obj, const std::filesystem::path& file) {
  const std::string folder = file.has_parent_path() ? file.parent_path().string() + "/" : std::string();
  std::vector<std::filesystem::path> found;
  TextLines lines(obj);
  while (const std::optional<std::string_view> line = lines.next()) {
    const Words words = split_words(*line);
    if (words.empty() || words[0] != "mtllib") continue;
    require(line->back() != '\\', "{}: line {}: a file of materials whose name goes on in the next line", file.string(),
            lines.number());
    if (found.empty()) found.push_back(std::filesystem::path(file).replace_extension("mtl"));
    if (words.size() < 2) continue;
    std::string name(words[1].data(), line->data() + line->size());
    name = name.substr(0, name.find('\f'));
    found.emplace_back(folder + name);  // the name may begin with /
  }
  return found;
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// ---------------------------------------------------------------- STL

constexpr std::size_t kStlHeader = 84;    // bytes, with the count of triangles at its end
constexpr std::size_t kStlTriangle = 50;  // bytes

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= kStlHeader &&
         bytes.size() - kStlHeader == kStlTriangle * std::size_t{little_endian(bytes, kStlHeader - 4)};
}

/// Checks the text of solids: each holds facets, a facet seven lines.
class StlCheck {
 public:
  StlCheck(std::string_view text, const std::string& source) : lines_(text), source_(source) {}

  void check() {
    while (const std::optional<Words> begin = next_line()) {
      expect(*begin, "solid", 0, true);
      Words line = required_line("facet or endsolid");
      for (; line.front() == "facet"; line = required_line("facet or endsolid")) check_facet(line);
      expect(line, "endsolid", 0, true);
    }
  }

 private:
  /// Returns the words of the next line that has some.
  std::optional<Words> next_line() {
    while (const std::optional<std::string_view> line = lines_.next()) {
      Words words = split_words(*line);
      if (!words.empty()) return words;
    }
    return std::nullopt;
  }

  Words required_line(const char* expected) {
    const std::optional<Words> words = next_line();
    require(words.has_value(), "{}: ends behind line {}, expected {}", source_, lines_.number(), expected);
    return *words;
  }

  void check_facet(const Words& first) {
    require(first.size() == 5 && first[1] == "normal", "{}: line {}, expected 'facet normal X Y Z'", source_,
            lines_.number());
    expect({first.begin() + 1, first.end()}, "normal", 3, false);
    const Words loop = required_line("outer loop");
    require(loop.size() == 2 && loop[0] == "outer" && loop[1] == "loop", "{}: line {}, expected 'outer loop'", source_,
            lines_.number());
    for (int corner = 0; corner < 3; ++corner) expect(required_line("vertex"), "vertex", 3, false);
    expect(required_line("endloop"), "endloop", 0, false);
    expect(required_line("endfacet"), "endfacet", 0, false);
  }

  /// Checks a line of a word and so many numbers, or a word and a name.
  void expect(const Words& words, std::string_view word, std::size_t numbers, bool has_name) const {
    const bool is_whole = words.front() == word && (has_name || words.size() == numbers + 1) &&
                          std::all_of(words.begin() + 1, words.end(), [&](std::string_view other) {
                            // The library takes a word of a name for the line that begins so.
                            if (has_name) return !is_word_of(" facet vertex endsolid ", other);
                            const std::optional<double> value = parse_number<double>(other);
                            return value && std::isfinite(*value);
                          });
    require(is_whole, "{}: line {} '{}', expected '{}'{}", source_, lines_.number(), excerpt(words.front()), word,
            numbers > 0 ? " and three numbers" : "");
  }

  TextLines lines_;
  const std::string& source_;
};

// ---------------------------------------------------------------- glTF

using Json = nlohmann::json;

/// Checks one asset and its parts. The library itself refuses an index without a target, and missing buffers.
class GltfCheck {
 public:
  GltfCheck(std::string_view bytes, const std::string& source) : source_(source), text_(bytes) {
    if (bytes.substr(0, 4) == "glTF") take_chunks(bytes);
    json_ = parse_json(text_, source_);
    require(json_.is_object(), "{}: no glTF, or cut: its JSON does not end", source_);
  }

  void check() const {
    for (const Json& view : list("bufferViews")) check_view(view);
    for (const Json& accessor : list("accessors")) check_accessor(accessor);
    for (const Json& mesh : list("meshes")) {
      require(mesh.value("primitives", Json()).is_array(), "{}: a mesh without parts", source_);
      for (const Json& primitive : mesh["primitives"]) check_primitive(primitive);
    }
    check_nodes();
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
    if (!entry.contains(name) && otherwise >= 0) return otherwise;
    const Json value = entry.value(name, Json());
    require(value.is_number_unsigned() && value <= 0xFFFFFFFFU, "{}: '{}' is {}, expected a whole number", source_,
            name, value.dump(-1, ' ', false, Json::error_handler_t::replace));
    return value.get<std::int64_t>();
  }

  /// Returns the entry of a list that an index names.
  const Json& named(const Json& entry, const char* name, const char* of) const {
    const std::int64_t at = number(entry, name);
    require(at < static_cast<std::int64_t>(list(of).size()), "{}: '{}' names {} of {} {}", source_, name, at,
            list(of).size(), of);
    return list(of)[static_cast<std::size_t>(at)];
  }

  /// Returns the number of bytes of a buffer: the first one of a GLB is in the file, others lie where the library looks
  /// for them.
  std::int64_t buffer_bytes(const Json& buffer) const {
    const std::int64_t bytes = number(buffer, "byteLength");
    const auto there = static_cast<std::int64_t>(binary_.size());
    require(!is_here(buffer) || bytes <= there, "{}: a buffer of {} bytes, {} are there", source_, bytes, there);
    return bytes;
  }

  bool is_here(const Json& buffer) const { return has_binary_ && &buffer == &list("buffers").front(); }

  void check_view(const Json& view) const {
    const std::int64_t bytes = buffer_bytes(named(view, "buffer", "buffers"));
    const std::int64_t end = number(view, "byteOffset", 0) + number(view, "byteLength");
    const std::int64_t stride = number(view, "byteStride", 0);
    require(end <= bytes, "{}: a view up to byte {} of a buffer of {}", source_, end, bytes);
    require(stride == 0 || (stride >= 4 && stride <= 252), "{}: a stride of {}, expected 4 to 252", source_, stride);
  }

  std::int64_t component_bytes(const Json& accessor) const {
    static const std::map<std::int64_t, std::int64_t> kBytes = {{5120, 1}, {5121, 1}, {5122, 2},
                                                                {5123, 2}, {5125, 4}, {5126, 4}};
    const auto found = kBytes.find(number(accessor, "componentType"));
    return found == kBytes.end() ? 0 : found->second;
  }

  static std::int64_t components(const Json& accessor) {
    static const std::map<Json, std::int64_t> kCounts = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                         {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    const auto found = kCounts.find(accessor.value("type", Json()));
    return found == kCounts.end() ? 0 : found->second;
  }

  void check_accessor(const Json& accessor) const {
    require(!accessor.contains("sparse"), "{}: sparse numbers, expected all of them", source_);
    const Json& view = named(accessor, "bufferView", "bufferViews");
    const std::int64_t size = component_bytes(accessor) * components(accessor);
    const std::int64_t count = number(accessor, "count");
    const std::int64_t stride = number(view, "byteStride", 0) == 0 ? size : number(view, "byteStride", 0);
    require(size > 0 && count > 0 && stride >= size, "{}: {} entries of {} bytes every {}, expected some", source_,
            count, size, stride);
    const std::int64_t end = number(accessor, "byteOffset", 0) + stride * (count - 1) + size;
    require(end <= number(view, "byteLength"), "{}: entries up to byte {} of a view of {}", source_, end,
            number(view, "byteLength"));
  }

  void check_primitive(const Json& primitive) const {
    const Json attributes = primitive.value("attributes", Json());
    require(attributes.is_object() && !primitive.contains("targets"),
            "{}: a part of a mesh without numbers, or one that changes its shape", source_);
    const Json& positions = named(attributes, "POSITION", "accessors");
    const std::int64_t vertices = number(positions, "count");
    require(components(positions) == 3 && number(positions, "componentType") == 5126,
            "{}: positions are not three floats each", source_);
    for (const auto& [name, value] : attributes.items()) {
      const Json& other = named(attributes, name.c_str(), "accessors");
      const std::int64_t width = components(other);
      require(number(other, "count") == vertices, "{}: {} entries {} for {} vertices", source_, number(other, "count"),
              name, vertices);
      require(name != "NORMAL" || width == 3, "{}: normals of {} numbers", source_, width);
      require(name.rfind("TEXCOORD", 0) != 0 || width == 2, "{}: texture coordinates of {} numbers", source_, width);
      require(name.rfind("COLOR", 0) != 0 || width == 3 || width == 4, "{}: colours of {} numbers", source_, width);
    }
    require(number(primitive, "mode", 4) <= 6, "{}: a part of kind {}, expected 0 to 6", source_,
            number(primitive, "mode", 4));
    if (primitive.contains("indices")) check_indices(named(primitive, "indices", "accessors"), vertices);
  }

  /// The library ignores faces with an invalid vertex, so that these are refused here.
  void check_indices(const Json& indices, std::int64_t vertices) const {
    const std::int64_t type = number(indices, "componentType");
    require(components(indices) == 1 && (type == 5121 || type == 5123 || type == 5125),
            "{}: corners that are no whole numbers", source_);
    const Json& view = named(indices, "bufferView", "bufferViews");
    if (!is_here(named(view, "buffer", "buffers"))) return;
    const auto size = static_cast<std::size_t>(component_bytes(indices));
    const auto stride = static_cast<std::size_t>(number(view, "byteStride", static_cast<std::int64_t>(size)));
    auto at = static_cast<std::size_t>(number(view, "byteOffset", 0) + number(indices, "byteOffset", 0));
    for (std::int64_t left = number(indices, "count"); left > 0; --left, at += stride) {
      std::uint32_t vertex = 0;
      std::memcpy(&vertex, binary_.data() + at, size);
      require(vertex < vertices, "{}: a face names vertex {}, expected one of {}", source_, vertex, vertices);
    }
  }

  /// Every node has one parent at most and not too many above it, so that walking down them comes to an end.
  void check_nodes() const {
    constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    constexpr int kDeepest = 200;
    const Json& nodes = list("nodes");
    std::vector<std::size_t> parents(nodes.size(), kNone);
    const auto is_free_node = [&](const Json& entry) {
      return entry.is_number_unsigned() && entry < nodes.size() && parents[entry.get<std::size_t>()] == kNone;
    };
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      for (const auto& [name, count] : {std::pair{"matrix", 16U}, {"rotation", 4U}, {"scale", 3U}, {"translation", 3U}})
        check_numbers(nodes[n], name, count);
      for (const Json& child : nodes[n].value("children", Json::array())) {
        require(is_free_node(child), "{}: node {} has an invalid child, or one with two parents", source_, n);
        parents[child.get<std::size_t>()] = n;
      }
    }
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      int depth = 0;
      for (std::size_t above = parents[n]; above != kNone; above = parents[above])
        require(++depth < kDeepest, "{}: nodes below one another {} times or more, or their own children", source_,
                kDeepest);
    }
    for (const Json& scene : list("scenes")) {
      for (const Json& root : scene.value("nodes", Json::array()))
        require(is_free_node(root), "{}: a scene begins with an invalid node, or with a node's child", source_);
    }
  }

  void check_numbers(const Json& node, const char* name, std::size_t count) const {
    const Json numbers = node.value(name, Json::array());
    const bool are_numbers = std::all_of(numbers.begin(), numbers.end(), [](const Json& n) { return n.is_number(); });
    require(!node.contains(name) || (numbers.is_array() && numbers.size() == count && are_numbers),
            "{}: a node's {} is not {} numbers", source_, name, count);
  }

  const std::string& source_;
  std::string_view text_;
  std::string_view binary_;
  bool has_binary_ = false;
  Json json_;
};

}  // namespace

void check_ply(std::string_view bytes, const std::string& source) {
  PlyCheck(bytes, source).check();
}

void check_obj(std::string_view bytes, const std::filesystem::path& file) {
  const std::string source = file.string();
  require(bytes.find('\0') == std::string_view::npos, "{}: holds a byte 0, expected text", source);
  ObjCheck(bytes, source).check();
  for (const std::filesystem::path& materials : material_files(bytes, file)) {
    std::error_code error;
    if (!std::filesystem::exists(materials, error)) continue;
    check_mtl(read_file(materials, "an OBJ's materials"), materials.string());
  }
}

void check_stl(std::string_view bytes, const std::string& source) {
  if (is_binary_stl(bytes)) return;
  require(bytes.substr(0, 5) == "solid" && bytes.find('\0') == std::string_view::npos,
          "{}: {} bytes, expected {} and {} for each triangle that its header states, or a text that begins with "
          "'solid'",
          source, bytes.size(), kStlHeader, kStlTriangle);
  StlCheck(bytes, source).check();
}

void check_mtl(std::string_view bytes, const std::string& source) {
  constexpr std::size_t kMaxLineLength = 1000;
  require(bytes.find('\0') == std::string_view::npos, "{}: holds a byte 0, expected text", source);
  bool has_material = false;
  TextLines lines(bytes);
  while (const std::optional<std::string_view> line = lines.next()) {
    require(line->size() <= kMaxLineLength, "{}: line {} of {} bytes, expected at most {}", source, lines.number(),
            line->size(), kMaxLineLength);
    const Words words = split_words(*line);
    if (!words.empty())
      check_mtl_line(words, has_material, fmt::format("{}: line {} '{}'", source, lines.number(), excerpt(*line)));
  }
  // The library refuses what is shorter than a material with a name, without closing the file.
  constexpr std::size_t kMinBytes = std::string_view("newmtl a").size();
  require(bytes.empty() || bytes.size() >= kMinBytes, "{}: {} bytes, expected none, or {} and more", source,
          bytes.size(), kMinBytes);
}

void check_gltf(std::string_view bytes, const std::string& source) {
  try {
    GltfCheck(bytes, source).check();
  } catch (const nlohmann::json::exception& error) {
    fail("{}: damaged glTF: {}", source, error.what());
  }
}

}  // namespace houghstream
