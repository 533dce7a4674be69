#include "tools/common/mesh_size.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/geometry/tetrahedron.hpp"

namespace houghstream {
namespace {

TEST(MeshSize, ObjectsOfACamerasRangeAreAsTheyShouldBe) {
  for (const double size_m : {0.01, 0.2, 1.5}) EXPECT_EQ(mesh_size_error(size_m, 1e-3, "--unit"), "") << size_m;
}

TEST(MeshSize, WhatIsReadInAWrongUnitIsToldTheRightOne) {
  EXPECT_EQ(mesh_size_error(1.6, 1e-2, "--model-unit"),
            "1.6 m across when read in cm, expected 0.01 to 1.5 m, what the camera sees: "
            "--model-unit mm would make it 0.16 m");
  EXPECT_EQ(mesh_size_error(0.0002, 1e-3, "--unit"),
            "0.0002 m across when read in mm, expected 0.01 to 1.5 m, what the camera sees: "
            "--unit m would make it 0.2 m");
  EXPECT_EQ(mesh_size_error(40.0, 1e-3, "--unit"),
            "40 m across when read in mm, expected 0.01 to 1.5 m, what the camera sees");
}

TEST(MeshSize, ModelsAreToldInOneLine) {
  std::map<std::string, Mesh> models = {{"bowl", tetrahedron(1.0F)}, {"mug", tetrahedron(0.1F)}};
  const std::string one = fault_of_sizes(models, 1e-2, "--model-unit");
  EXPECT_EQ(one.rfind("model 'bowl': 1.732 m across when read in cm, ", 0), 0U) << one;
  EXPECT_EQ(one.find("models"), std::string::npos) << one;
  models["plate"] = tetrahedron(2.0F);
  const std::string two = fault_of_sizes(models, 1e-2, "--model-unit");
  EXPECT_EQ(two, one + "; so it is with 2 of 3 models");
  models = {{"mug", tetrahedron(0.1F)}};
  EXPECT_EQ(fault_of_sizes(models, 1e-3, "--model-unit"), "");
}

}  // namespace
}  // namespace houghstream
