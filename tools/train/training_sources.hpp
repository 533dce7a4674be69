#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/types/training_view.hpp"

namespace houghstream {

/// Places of training data, as the command line names them.
struct TrainingSources {
  std::vector<std::string> views;        ///< "bop:DIR" or "uw:DIR"
  std::vector<std::string> backgrounds;  ///< "bop:DIR" or "images:DIR"
  std::vector<std::string> instances;    ///< instances of uw: folders to read; empty = all
  std::vector<std::string> renames;      ///< "can_1=can": what an instance is called; equal names are one class
  std::optional<std::string> camera;     ///< camera for data that publish none, see parse_camera
};

/// Reads everything; class ids of uw: folders count from 1 in the order of their names. Throws InputError, also for
/// instances and renames that have no effect.
std::vector<TrainingView> read_training_sources(const TrainingSources& sources, int threads = 1);

}  // namespace houghstream
