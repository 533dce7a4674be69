#include "pipeline/base/checks.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/fuse/fuse_models.hpp"
#include "tools/train/training_sources.hpp"

int main(int argc, char** argv) {
  using namespace houghstream;
  CommandLine app("Makes models of objects that have none, from their training views: views with masks in, models/ out",
                  "hs-fuse");
  TrainingSources sources;
  fusion::FusionSettings settings;
  FuseOutputs outputs;
  double voxel_mm = 1e3 * settings.grid.voxel;
  app.add_option("--views", sources.views, "training views: bop:DIR (poses are taken as they are) or uw:DIR")
      .required();
  app.add_option("--instances", sources.instances, "instances of a uw: folder").delimiter(',');
  app.add_option("--rename", sources.renames, "can_1=can: what an instance is called").delimiter(',');
  app.add_option("--camera", sources.camera, "WIDTHxHEIGHT,fx,fy,cx,cy, for data that publish none");
  app.add_option("--out", outputs.models, "models/ folder to write, for --models of the other tools").required();
  app.add_flag("--replace", outputs.replace, "models that are there already give way");
  app.add_option("--pictures", outputs.images, "folder for a picture of each model from several sides");
  app.add_option("--voxel", voxel_mm, "edge of a voxel, millimetres; triangles are about as large")
      .range(0.2, 20.0)
      .capture_default_str();
  app.add_option("--axis-iterations", settings.alignment.iterations, "of the correction of a uw: turntable's axis")
      .range(0, 1000)
      .capture_default_str();
  app.add_option("--threads", settings.threads, "any number gives the same models").range(1, 64).capture_default_str();
  app.add_example("hs-fuse --views uw:VIEWS --camera 640x480,525,525,319.5,239.5 --out MODELS");
  return run_tool(app, argc, argv, [&] {
    check_outputs(outputs, sources.views);
    settings.grid.voxel = 1e-3 * voxel_mm;
    fuse_models(group_views(read_training_sources(sources, settings.threads)), settings, outputs);
  });
}
