#pragma once

#include <optional>
#include <set>
#include <string>

#include "pipeline/types/detection.hpp"

namespace houghstream {

/// Notices that the models and the detector do not know each other's objects: no pose can come of it, and the reason
/// stands in every single pose only. Not thread-safe.
class ModelCheck {
 public:
  /// `models` are the classes that have one. Without any it notices nothing, since there is nothing to compare with.
  explicit ModelCheck(std::set<std::string> models) : models_(std::move(models)) {}

  /// A class that has one from here on.
  void add_model(const std::string& name) { models_.insert(name); }

  /// Returns whether it will log nothing more.
  bool settled() const { return settled_; }

  /// Returns a warning that names both sides' classes, once, if the first ten detections_t that are not empty hold no
  /// class with a model.
  std::optional<std::string> note(const Detections& detections);

  /// Checks at the end of the stream, where fewer have arrived and no more will.
  std::optional<std::string> at_end();

 private:
  std::set<std::string> models_;
  std::set<std::string> detected_;
  int checked_ = 0;
  bool settled_ = false;  // a class with a model has come, or the warning was returned
};

}  // namespace houghstream
