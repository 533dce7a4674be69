#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "drivers/store/object_store.hpp"
#include "tools/teach/mesh/lookalikes.hpp"

namespace houghstream::teach {

/// Parts of a store's page beside its list.
struct StoreReportParts {
  std::map<int, Eigen::Vector3d> sizes_m;  ///< sizes by id, NaN where unknown (object_sizes())
  std::map<int, std::string> images;       ///< JPEG files of the objects' views by id; an object may have none
  std::vector<Lookalike> lookalikes;       ///< pairs that look alike by their meshes
};

/// Returns a page of the store in HTML, with everything it shows within it: a table of the objects, which can hardly be
/// told apart, and for each object its views, its recall in practice by distance and by visible fraction, and its
/// precision over recall. What practice has not counted is named. Names are escaped.
std::string store_page(const store::ObjectStore& store, const StoreReportParts& parts);

/// Writes the page of a store to a file. Throws InputError where the store cannot be read, where the file is there and
/// is no such page, and where it cannot be written or lies among the store's own entries.
void write_store_report(const std::filesystem::path& folder, const std::filesystem::path& out);

}  // namespace houghstream::teach
