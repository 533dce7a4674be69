#pragma once

#include <filesystem>
#include <vector>

namespace houghstream::teach {

/// Joins stores that were taught apart into `out`: each keeps its groups, whose forests are copied bit for bit. The
/// result depends on the objects alone, neither on the order of the stores nor on what was merged before. An id that
/// two objects were taught with stays that of the first by name, and the other gets the next free one. Says that
/// scores are to be practised among one another. Throws InputError in one line, and writes nothing, for two objects of
/// one name or one mesh, stores that cannot be searched together or were taught with other seeds, and for a store that
/// is there where `replace` is not set.
void merge_stores(const std::vector<std::filesystem::path>& stores, const std::filesystem::path& out, bool replace);

}  // namespace houghstream::teach
