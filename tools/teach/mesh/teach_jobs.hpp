#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/teach/mesh/store_contents.hpp"
#include "tools/teach/mesh/teach_options.hpp"

namespace houghstream::teach {

/// Throws InputError where a store is there, also one that cannot be read: a teaching that neither adds to it nor was
/// asked to replace it would lose its objects. Of other folders StoreTransaction takes empty ones only.
void require_no_store(const std::filesystem::path& folder);

/// Teaches objects from their meshes. Says on standard error what is done, and at the end which objects can hardly be
/// told apart, and on standard output teaching_summary(). The store that was there stays whole until the new one is.
/// Throws InputError for what cannot be taught, and before all work for a store that is there where `options` say
/// neither add nor replace.
void teach_meshes(const TeachOptions& options);

/// Logs which objects of a store can hardly be distinguished, by their meshes and by their calibration.
void log_lookalikes(const std::vector<StoreModel>& models, const store::ObjectStore& list);

/// Recalibrates scores and qualities of a store's objects: of all, or of those of the `names`. Throws InputError for a
/// name that is not there.
void calibrate_store(const std::filesystem::path& folder, const CalibrationSettings& settings,
                     const std::vector<std::string>& names = {});

/// Takes an object out of the store. Throws InputError where it is not there, or the only one.
void remove_from_store(const std::filesystem::path& folder, const std::string& name);

}  // namespace houghstream::teach
