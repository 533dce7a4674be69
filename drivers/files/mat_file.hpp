#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

// MATLAB files of version 5 (what MATLAB 5 to 7.2 save, and later ones unless asked for 7.3), after "MAT-File Format",
// The MathWorks. Read here and not by a library, since those at hand crash on damaged files.

namespace houghstream {

/// An array of a MATLAB file.
struct MatArray {
  enum class Kind { kNumbers, kText, kCells, kStructs, kOther };
  Kind kind = Kind::kOther;
  std::string name;
  std::size_t count = 0;            ///< elements
  std::vector<double> values;       ///< of numbers, and the character codes of text
  std::vector<std::string> fields;  ///< of structs
  std::vector<MatArray> children;   ///< cells; or the structs' fields, struct by struct
};

/// A variable of a file with all that it holds. Throws InputError where the file is missing, no MATLAB file of this
/// version or damaged, or lacks the variable.
MatArray read_mat_variable(const std::filesystem::path& file, const std::string& name);

/// The field of element `index` of a struct array as one finite number. Throws InputError.
double mat_number(const MatArray& structs, std::size_t index, const std::string& field, const std::string& where);

/// The same as text of printable ASCII characters.
std::string mat_text(const MatArray& structs, std::size_t index, const std::string& field, const std::string& where);

/// "numbers", "text", "cells", "structs" or "something else".
const char* mat_kind_name(MatArray::Kind kind);

}  // namespace houghstream
