#include "tools/stream/stream_plan.hpp"

#include "tools/stream/shell_words.hpp"

namespace houghstream::stream {
namespace {

using Words = std::vector<std::string>;

/// hs-NAME with what all of them take, and with the further words.
ChildPlan plan(const StreamOptions& options, const std::string& name, const Words& words, const std::string& further) {
  ChildPlan plan;
  plan.name = name;
  plan.command = {(options.executables / ("hs-" + name)).string(), "--channel", options.channel};
  if (!options.lcm_url.empty()) plan.command.insert(plan.command.end(), {"--lcm-url", options.lcm_url});
  plan.command.insert(plan.command.end(), words.begin(), words.end());
  const Words more = shell_words(further, "--" + name + "-options");
  plan.command.insert(plan.command.end(), more.begin(), more.end());
  return plan;
}

}  // namespace

std::vector<ChildPlan> plan_stream(const StreamOptions& options) {
  const Words camera = options.camera.empty() ? Words() : Words{"--camera", options.camera};
  const bool has_store = !options.objects.empty();
  const Words store = {"--objects", options.objects};
  const Words forest = {"--forest", options.forest};
  const Words models = options.models.empty() ? Words() : Words{"--models", options.models};
  const auto with_camera = [&](Words words) {
    words.insert(words.end(), camera.begin(), camera.end());
    return words;
  };
  const bool own_looks = options.detect_options.find("--looks-per-second") != std::string::npos;
  const std::string looks = options.follow && !own_looks ? "--looks-per-second 5 " : "";
  const std::string follow = options.follow ? "--follow " : "";
  std::vector<ChildPlan> plans;
  plans.push_back(plan(options, "detect", with_camera(has_store ? store : forest), looks + options.detect_options));
  if (has_store || !models.empty())
    plans.push_back(plan(options, "pose", with_camera(has_store ? store : models), follow + options.pose_options));
  if (options.track)
    plans.push_back(plan(options, "track", with_camera(has_store ? store : models), options.track_options));
  if (options.view) {
    plans.push_back(plan(options, "view", with_camera(has_store ? store : models), options.view_options));
    plans.back().ends_stream = true;
  }
  if (!options.source.empty()) {
    plans.push_back(plan(options, "capture", {"--source", options.source}, options.capture_options));
    plans.back().ends_stream = true;
    plans.back().awaits_others = true;
  }
  return plans;
}

}  // namespace houghstream::stream
