#include "detector/baseline/baseline_scales.hpp"
#include "detector/baseline/gall_profile.hpp"
#include "tools/train/train_main.hpp"

int main(int argc, char** argv) {
  using namespace houghstream;
  TrainProgram program;
  program.name = "hs-study-train";
  program.profiles = baseline::profile_names();
  program.families = kAllFamilies;
  program.make_profile = [](const std::string& name) { return baseline::make_profile(name); };
  program.profile_of = baseline::profile_of;
  program.scales_of = baseline::scales_of;
  program.set_image_scale = baseline::set_image_scale;
  program.set_scale_handling = baseline::set_scale_handling;
  return train_main(argc, argv, program);
}
