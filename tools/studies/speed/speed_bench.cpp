#include "tools/studies/speed/speed_bench.hpp"

#include <fmt/format.h>
#include <hwy/targets.h>

#include <algorithm>
#include <chrono>
#include <numeric>

#include "pipeline/base/checks.hpp"
#include "pipeline/bus/percentiles.hpp"
#include "tools/common/rounded.hpp"

namespace houghstream {
namespace {

/// Highway's choice of an instruction set while this lives.
class InstructionSet {
 public:
  explicit InstructionSet(std::int64_t target) { choose(target); }
  InstructionSet(const InstructionSet&) = delete;
  InstructionSet& operator=(const InstructionSet&) = delete;
  ~InstructionSet() { choose(0); }

 private:
  static void choose(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

void look_at(const BenchmarkedDetector& contender, const RgbdFrame& frame, SpeedResult& result) {
  using Clock = std::chrono::steady_clock;
  const InstructionSet set(contender.instruction_set);
  const Clock::time_point start = Clock::now();
  const Detections found = contender.detect(frame);
  result.ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  for (const StageTime& stage : found.stages) {
    result.stage_ms[stage.stage].push_back(static_cast<double>(stage.duration_us) * 1e-3);
  }
  result.detections += found.detections.size();
}

}  // namespace

std::vector<SpeedResult> measure_speed(const std::vector<BenchmarkedDetector>& contenders,
                                       const std::vector<RgbdFrame>& frames) {
  require(!frames.empty(), "nothing to measure: the scene has no frames");
  std::vector<SpeedResult> results(contenders.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const std::size_t c = (i + f) % contenders.size();
      if (f >= contenders[c].frames) continue;
      const RgbdFrame frame = resized_frame(frames[f], contenders[c].image_scale);
      SpeedResult warm_up;
      if (f == 0 && contenders[c].frames > 3) look_at(contenders[c], frame, warm_up);
      look_at(contenders[c], frame, results[c]);
    }
  }
  return results;
}

nlohmann::json to_json(const std::vector<BenchmarkedDetector>& contenders, const std::vector<SpeedResult>& results) {
  nlohmann::json out = nlohmann::json::object();
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    const SpeedResult& result = results[c];
    nlohmann::json stages = nlohmann::json::object();
    for (const auto& [stage, ms] : result.stage_ms) stages[stage] = rounded(percentile(ms, 50.0), 3);
    out[contenders[c].name] = {{"ms",
                                {{"p10", rounded(percentile(result.ms, 10.0), 3)},
                                 {"p50", rounded(percentile(result.ms, 50.0), 3)},
                                 {"p90", rounded(percentile(result.ms, 90.0), 3)}}},
                               {"frames", result.ms.size()},
                               {"detections", result.detections},
                               {"stage_ms", stages}};
  }
  return out;
}

std::string speed_table(const std::vector<BenchmarkedDetector>& contenders, const std::vector<SpeedResult>& results) {
  std::vector<std::size_t> order(contenders.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto median = [&](std::size_t c) { return percentile(results[c].ms, 50.0); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return median(a) < median(b); });
  std::string table = fmt::format("{:<24}{:>12}{:>12}{:>12}{:>8}\n", "ms a frame", "median", "10 %", "90 %", "frames");
  for (const std::size_t c : order) {
    table += fmt::format("{:<24}{:>12.2f}{:>12.2f}{:>12.2f}{:>8}\n", contenders[c].name, median(c),
                         percentile(results[c].ms, 10.0), percentile(results[c].ms, 90.0), results[c].ms.size());
  }
  return table;
}

}  // namespace houghstream
