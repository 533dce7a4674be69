#pragma once

#include <filesystem>
#include <string>

namespace houghstream::teach {

/// An object's new name, everywhere in the store; all else stays as it is. Throws InputError where no object has the
/// old name, or another one has the new.
void rename_in_store(const std::filesystem::path& folder, const std::string& old_name, const std::string& new_name);

}  // namespace houghstream::teach
