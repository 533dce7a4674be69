#pragma once

#include <gtest/gtest.h>
#include <matio.h>
#include <zlib.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/test_files.hpp"

namespace houghstream {

/// Type of an annotation's field.
struct MatField {
  const char* name;
  std::string text;  ///< written as a number where empty
  double number = 0.0;
};
using MatBox = std::vector<MatField>;

/// Returns an annotation as the UW scenes have it.
inline MatBox uw_box(const std::string& category, double instance, const std::array<double, 4>& top_bottom_left_right) {
  const auto& [top, bottom, left, right] = top_bottom_left_right;
  return {{"category", category, 0.0}, {"instance", "", instance}, {"top", "", top},
          {"bottom", "", bottom},      {"left", "", left},         {"right", "", right}};
}

inline matvar_t* mat_double(const char* name, double value) {
  std::array<std::size_t, 2> one = {1, 1};
  return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, one.data(), &value, 0);
}

inline matvar_t* mat_char(const char* name, const std::string& text) {
  std::array<std::size_t, 2> size = {1, text.size()};
  std::string copy = text;
  return Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UINT8, 2, size.data(), copy.data(), 0);
}

/// Makes one frame's cell: an empty array, or a struct array with the fields of its first box.
inline matvar_t* mat_boxes(const std::vector<MatBox>& boxes) {
  std::array<std::size_t, 2> size = {boxes.empty() ? 0U : 1U, boxes.size()};
  if (boxes.empty()) return Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), nullptr, 0);
  std::vector<const char*> names;
  for (const MatField& field : boxes.front()) names.push_back(field.name);
  matvar_t* structs = Mat_VarCreateStruct(nullptr, 2, size.data(), names.data(), static_cast<unsigned>(names.size()));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const MatField& field : boxes[i]) {
      matvar_t* value = field.text.empty() ? mat_double(field.name, field.number) : mat_char(field.name, field.text);
      Mat_VarSetStructFieldByName(structs, field.name, i, value);
    }
  }
  return structs;
}

inline matvar_t* mat_cells(const char* name, const std::vector<matvar_t*>& cells) {
  std::array<std::size_t, 2> size = {1, cells.size()};
  matvar_t* array = Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, size.data(), nullptr, 0);
  for (std::size_t i = 0; i < cells.size(); ++i) Mat_VarSetCell(array, static_cast<int>(i), cells[i]);
  return array;
}

/// Writes one variable, which it frees.
inline void write_mat(const std::filesystem::path& file, matvar_t* variable) {
  mat_t* mat = Mat_CreateVer(file.c_str(), nullptr, MAT_FT_MAT5);
  ASSERT_NE(mat, nullptr);
  EXPECT_EQ(Mat_VarWrite(mat, variable, MAT_COMPRESSION_NONE), 0);
  Mat_VarFree(variable);
  Mat_Close(mat);
}

/// Compresses the only variable of a file, as MATLAB does (matio 1.5.23 states wrong sizes when it compresses).
inline void compress_mat(const std::filesystem::path& file) {
  constexpr std::size_t kHeader = 128;
  const std::string plain = read_text(file);
  uLongf size = compressBound(plain.size() - kHeader);
  std::vector<unsigned char> packed(size);
  ASSERT_EQ(compress(packed.data(), &size, reinterpret_cast<const unsigned char*>(plain.data()) + kHeader,
                     plain.size() - kHeader),
            Z_OK);
  const std::array<std::uint32_t, 2> tag = {15, static_cast<std::uint32_t>(size)};
  write_text(file, plain.substr(0, kHeader) + std::string(reinterpret_cast<const char*>(tag.data()), 8) +
                       std::string(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size)));
}

}  // namespace houghstream
