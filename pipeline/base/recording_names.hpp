#pragma once

#include <filesystem>
#include <optional>
#include <string>

// The names of recordings whose place is taken: one rule for every program that records.

namespace houghstream {

/// FILE where nothing has that name, else the first of FILE_2, FILE_3, ... that nothing has; the number stands before
/// the extension: take.oni, take_2.oni.
std::filesystem::path next_recording_name(const std::filesystem::path& file);

/// Renames the file that a killed program left while it wrote `file` to the first of FILE.interrupted-1.EXTENSION,
/// FILE.interrupted-2.EXTENSION, ... that does not exist, and returns the new name. `ending` is what the partial file
/// has behind `file`; its extension, if it has one beside ".partial", stays, since it names the format. Returns nothing
/// where there is no such file, it is empty, or a program still writes it. Throws InputError where it cannot be
/// renamed.
std::optional<std::filesystem::path> keep_interrupted(const std::filesystem::path& file, const std::string& ending);

/// Renames a file, unless something has the new name: then false, with errno EEXIST. False with errno otherwise too.
bool rename_to_free_name(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace houghstream
