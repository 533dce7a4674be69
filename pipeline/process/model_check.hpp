#pragma once

#include <optional>
#include <set>
#include <string>

#include "pipeline/types/detection.hpp"

namespace houghstream {

/// Detects that models and detector have no object in common, so that no pose can be estimated; without it only the
/// status of each single pose would say so. Not thread-safe.
class ModelCheck {
 public:
  /// `models` names the classes that have a model; without any it never warns.
  explicit ModelCheck(std::set<std::string> models) : models_(std::move(models)) {}

  /// Adds a class that has a model from here on.
  void add_model(const std::string& name) { models_.insert(name); }

  /// Returns whether it will log nothing more.
  bool is_done() const { return is_done_; }

  /// Returns a warning that names both sides' classes, once, if the first ten detections_t that are not empty hold no
  /// class with a model.
  std::optional<std::string> note(const Detections& detections);

  /// Checks at the end of the stream, where fewer have arrived.
  std::optional<std::string> finish();

 private:
  std::set<std::string> models_;
  std::set<std::string> detected_;
  int checked_ = 0;
  bool is_done_ = false;  // a class with a model has come, or the warning was returned
};

}  // namespace houghstream
