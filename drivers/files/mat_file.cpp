#include "drivers/files/mat_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>

#include "drivers/files/mat_parser.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeaderBytes = 128;

std::vector<unsigned char> read_bytes(const fs::path& path) {
  require_regular_file(path, "a MATLAB file");
  constexpr std::uintmax_t kMostBytes = 16U << 20U;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  require(!error && size <= kMostBytes, "{}: {} bytes, expected at most {}", path.string(), size, kMostBytes);
  std::ifstream in(path, std::ios::binary);
  require(in.good() && fs::is_regular_file(path), "{}: missing or unreadable, expected a MATLAB file", path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<unsigned char> inflate_all(const MatBytes& packed, const std::string& where) {
  constexpr std::size_t kMostBytes = 16U << 20U;  // each 8 of them may be an array of a hundred
  z_stream stream{};
  require(inflateInit(&stream) == Z_OK, "{}: no memory to decompress", where);
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  stream.next_in = const_cast<unsigned char*>(packed.data());  // zlib only reads it
  stream.avail_in = static_cast<unsigned>(packed.size());
  std::vector<unsigned char> out;
  std::array<unsigned char, 65536> piece{};
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = piece.data();
    stream.avail_out = piece.size();
    state = inflate(&stream, Z_NO_FLUSH);
    out.insert(out.end(), piece.data(), stream.next_out);
    require(out.size() <= kMostBytes, "{}: more than {} bytes decompressed", where, kMostBytes);
  }
  require(state == Z_STREAM_END, "{}: compressed data are damaged (zlib says {})", where, state);
  return out;
}

bool check_header(const std::vector<unsigned char>& bytes, const std::string& file) {
  const bool long_enough = bytes.size() >= kHeaderBytes;
  const std::string order = long_enough ? std::string(bytes.begin() + 126, bytes.begin() + 128) : "";
  require(order == "IM" || order == "MI", "{}: no MATLAB file, expected the header of version 5", file);
  const bool swapped = order == "MI";  // written by a machine of the other byte order
  const int version = swapped ? bytes[124] : bytes[125];
  require(version == 1, "{}: MATLAB file version {}, expected 1 (-v5, -v6 or -v7, not -v7.3)", file, version);
  return swapped;
}

const MatArray& struct_field(const MatArray& structs, std::size_t index, const std::string& field,
                             const std::string& where) {
  require(structs.kind == MatArray::Kind::kStructs, "{}: {}, expected structs", where, mat_kind_name(structs.kind));
  const auto found = std::find(structs.fields.begin(), structs.fields.end(), field);
  require(found != structs.fields.end(), "{}: no field '{}'", where, field);
  const auto column = static_cast<std::size_t>(found - structs.fields.begin());
  return structs.children.at(index * structs.fields.size() + column);
}

}  // namespace

const char* mat_kind_name(MatArray::Kind kind) {
  constexpr std::array<const char*, 5> kNames = {"numbers", "text", "cells", "structs", "something else"};
  return kNames[static_cast<std::size_t>(kind)];
}

MatArray read_mat_variable(const fs::path& path, const std::string& name) {
  const std::string file = path.string();
  const std::vector<unsigned char> bytes = read_bytes(path);
  const bool swapped = check_header(bytes, file);
  MatBytes rest(bytes.data() + kHeaderBytes, bytes.size() - kHeaderBytes, swapped, file);
  while (rest.size() > 0) {
    MatElement element = rest.take_element(false);
    std::vector<unsigned char> unpacked;
    if (element.type == MatType::kCompressed) {
      unpacked = inflate_all(element.bytes, file);
      element = MatBytes(unpacked.data(), unpacked.size(), swapped, file).take_element(true);
    }
    if (element.type != MatType::kMatrix) continue;
    MatArray array = parse_mat_array(element.bytes);
    if (array.name == name) return array;
  }
  fail("{}: no variable '{}'", file, name);
}

double mat_number(const MatArray& structs, std::size_t index, const std::string& field, const std::string& where) {
  const MatArray& array = struct_field(structs, index, field, where);
  require(array.kind == MatArray::Kind::kNumbers, "{} field '{}': {}, expected a number", where, field,
          mat_kind_name(array.kind));
  require(array.count == 1, "{} field '{}': {} numbers, expected one", where, field, array.count);
  require(std::isfinite(array.values[0]), "{} field '{}': {}, expected a finite number", where, field, array.values[0]);
  return array.values[0];
}

std::string mat_text(const MatArray& structs, std::size_t index, const std::string& field, const std::string& where) {
  const MatArray& array = struct_field(structs, index, field, where);
  require(array.kind == MatArray::Kind::kText && array.count > 0, "{} field '{}': {} of length {}, expected text",
          where, field, mat_kind_name(array.kind), array.count);
  std::string text;
  for (const double code : array.values) {
    require(code >= 0x20 && code < 0x7f, "{} field '{}': character {}, expected printable ASCII", where, field, code);
    text += static_cast<char>(code);
  }
  return text;
}

}  // namespace houghstream
