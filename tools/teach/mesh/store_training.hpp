#pragma once

#include <functional>
#include <string>
#include <vector>

#include "detector/forest/forest.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/types/training_view.hpp"
#include "tools/teach/mesh/teach_options.hpp"

namespace houghstream::teach {

/// Returns the meshes as a models/ folder of a BOP dataset has them.
std::vector<NamedModel> models_of(const std::vector<TaughtMesh>& meshes);

/// Renders training views of all objects, in order, with those of a camera behind the rendered ones; their votes are
/// for the middle of each mesh's box. The objects join `new_store`, their images its folder, and a dump the views where
/// one is wanted; `report` gets a line for each object. Throws InputError for a mesh of which no view shows any depth.
std::vector<TrainingView> make_views(const std::vector<TaughtMesh>& meshes, const TeachOptions& options,
                                     store::ObjectStore& new_store,
                                     const std::function<void(const std::string&)>& report);

/// Trains the forest of a group, from the views of its objects and of rooms. With an `old` one, which else is null,
/// that with these objects added, and of the profile of `options` only what is for training. `report` gets a line for
/// each step.
Forest train_store_forest(std::vector<TrainingView> views, const Forest* old, const TeachOptions& options,
                          const std::function<void(const std::string&)>& report);

}  // namespace houghstream::teach
