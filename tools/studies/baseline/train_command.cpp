#include "detector/baseline/baseline_scales.hpp"
#include "detector/baseline/gall_profile.hpp"
#include "tools/studies/commands.hpp"
#include "tools/train/train_main.hpp"

int houghstream::studies::train_command(CommandLine& app, int argc, char** argv) {
  TrainProgram program;
  program.name = app.name();
  program.profiles = baseline::profile_names();
  program.families = kAllFamilies;
  program.make_profile = [](const std::string& name) { return baseline::make_profile(name); };
  program.profile_of = baseline::profile_of;
  program.scales_of = baseline::scales_of;
  program.set_image_scale = baseline::set_image_scale;
  program.set_scale_handling = baseline::set_scale_handling;
  return train_main(argc, argv, program);
}
