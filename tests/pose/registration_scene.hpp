#pragma once

#include <utility>

#include "pose/registration/registration.hpp"
#include "tests/pose/test_scene.hpp"

namespace houghstream::test_scene {

/// An object on a table whose top is at z = `foot` of its frame, and an engine's way from a start.
struct RegistrationScene {
  Mesh object;
  Mesh ground = table();
  Eigen::Isometry3d truth;
  RgbdFrame frame;
  ObjectModel model;
  SurfaceError surface_error;

  RegistrationScene(Mesh mesh, double foot, const Eigen::Isometry3d& pose)
      : object(std::move(mesh)), truth(pose), surface_error(object) {
    frame = noisy_frame({{&object, truth, 1}, {&ground, truth * Eigen::Translation3d(0, 0, foot), 2}}, 7);
    model = make_object_model("it", object, ModelSettings());
  }
  ObjectObservation seen() const {
    return observe_object({frame, {}, {}}, detection_of("it", object, truth, 1), model, {});
  }
  RegistrationResult with(RegistrationEngine engine, const Eigen::Isometry3d& start, int iterations) const {
    return engine(seen(), start, {iterations, 400, 0.035, 0.012}, RegistrationSettings());
  }
  RegistrationResult projective(const Eigen::Isometry3d& start) const { return with(register_projective, start, 20); }
  double error(const RegistrationResult& result) const { return surface_error(truth, result.T_camera_object); }
};

}  // namespace houghstream::test_scene
