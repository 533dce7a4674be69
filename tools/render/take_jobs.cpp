#include "tools/render/take_jobs.hpp"

#include <algorithm>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/render/ordered_frames.hpp"
#include "tools/render/world/takes/take.hpp"

namespace houghstream::render {

using namespace world;

namespace {

std::vector<NumberedTake> selected_takes(const TakesJob& job) {
  const DatasetSplit use = job.development ? DatasetSplit::kTraining : DatasetSplit::kTest;
  const std::vector<NumberedTake> all = twelve_objects_takes(use, job.world, (job.frames - 1) / job.fps);
  const bool every_object = job.objects == std::vector<std::string>{"all"};
  std::vector<std::string> names;
  for (const NumberedTake& take : all) {
    if (take.take == 1) names.push_back(take.object);
  }
  for (const std::string& name : job.objects) {
    require(every_object || std::find(names.begin(), names.end(), name) != names.end(),
            "object \"{}\": expected all or one of {}", name, fmt::join(names, ", "));
  }
  std::vector<NumberedTake> selected;
  for (const NumberedTake& take : all) {
    const bool wanted =
        every_object || std::find(job.objects.begin(), job.objects.end(), take.object) != job.objects.end();
    if (wanted && take.take == job.take.value_or(take.take)) selected.push_back(take);
  }
  return selected;
}

OrderedJson take_entry(const NumberedTake& take, const TakesJob& job) {
  OrderedJson entry;
  entry["scene"] = take.scene;
  entry["object"] = take.object;
  entry["id"] = take.plan.object_id;
  entry["kind"] = take_kind_name(take.plan.kind);
  entry["take"] = take.take;
  entry["frames"] = job.frames;
  entry["fps"] = job.fps;
  return entry;
}

std::filesystem::path folder_of(const RenderOptions& options, const NumberedTake& take) {
  return options.out / "test" / fmt::format("{:06d}", take.scene);
}

void render_take(const RenderOptions& options, const NumberedTake& numbered, int frames) {
  const RenderedTake take(numbered.plan, frames, options.threads);
  BopWriter writer(folder_of(options, numbered));
  render_in_order(
      fmt::format("{} {}", numbered.object, numbered.take), options.threads, frames,
      [&](int index) { return take.render(index); },
      [&](const RenderedFrame& view) { writer.add(view.frame, view.objects, view.visible_masks); });
  writer.finish();
}

}  // namespace

void render_takes(const RenderOptions& options, const TakesJob& job) {
  require(job.frames >= 2 && job.frames <= 20000, "takes: {} frames, expected 2 to 20000", job.frames);
  require(job.fps >= 1.0 && job.fps <= 120.0, "takes: {} frames a second, expected 1 to 120", job.fps);
  const std::vector<NumberedTake> takes = selected_takes(job);
  std::vector<TaughtObject> objects;
  OrderedJson index = OrderedJson::array();
  for (const NumberedTake& take : takes) {
    index.push_back(take_entry(take, job));
    if (objects.empty() || objects.back().id != take.plan.object_id)
      objects.push_back(make_taught_object(take.plan.object_id));
  }
  for (const NumberedTake& take : takes) fresh_scene(options, folder_of(options, take));
  write_models(options, objects);
  for (const NumberedTake& take : takes) render_take(options, take, job.frames);
  write_json(index, options.out / "takes.json");
}

}  // namespace houghstream::render
