#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "detector/forest/forest.hpp"
#include "pipeline/types/training_view.hpp"
#include "tools/teach/mesh/teach_options.hpp"

namespace houghstream::teach {

/// The forest of a teaching, from the views of its objects and of rooms. With an `old` one, that with these objects
/// added, and of the profile of `options` only what is for training. `report` gets a line for each step.
Forest train_store_forest(std::vector<TrainingView> views, const std::optional<Forest>& old,
                          const TeachOptions& options, const std::function<void(const std::string&)>& report);

}  // namespace houghstream::teach
