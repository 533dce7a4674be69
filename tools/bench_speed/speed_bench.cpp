#include "tools/bench_speed/speed_bench.hpp"

#include <fmt/format.h>
#include <hwy/targets.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

/// The value that a share of the values do not exceed; nearest rank.
double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

double rounded(double ms) {
  return std::round(ms * 1e3) / 1e3;
}

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

void look_at(const Contender& contender, const RgbdFrame& frame, SpeedResult& result) {
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

std::vector<SpeedResult> measure_speed(const std::vector<Contender>& contenders, const std::vector<RgbdFrame>& frames) {
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

nlohmann::json to_json(const std::vector<Contender>& contenders, const std::vector<SpeedResult>& results) {
  nlohmann::json out = nlohmann::json::object();
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    const SpeedResult& result = results[c];
    nlohmann::json stages = nlohmann::json::object();
    for (const auto& [stage, ms] : result.stage_ms) stages[stage] = rounded(quantile(ms, 0.5));
    out[contenders[c].name] = {{"ms",
                                {{"p10", rounded(quantile(result.ms, 0.1))},
                                 {"p50", rounded(quantile(result.ms, 0.5))},
                                 {"p90", rounded(quantile(result.ms, 0.9))}}},
                               {"frames", result.ms.size()},
                               {"detections", result.detections},
                               {"stage_ms", stages}};
  }
  return out;
}

std::string speed_table(const std::vector<Contender>& contenders, const std::vector<SpeedResult>& results) {
  std::vector<std::size_t> order(contenders.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto median = [&](std::size_t c) { return quantile(results[c].ms, 0.5); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return median(a) < median(b); });
  std::string table = fmt::format("{:<24}{:>12}{:>12}{:>12}{:>8}\n", "ms a frame", "median", "10 %", "90 %", "frames");
  for (const std::size_t c : order) {
    table += fmt::format("{:<24}{:>12.2f}{:>12.2f}{:>12.2f}{:>8}\n", contenders[c].name, median(c),
                         quantile(results[c].ms, 0.1), quantile(results[c].ms, 0.9), results[c].ms.size());
  }
  return table;
}

}  // namespace houghstream
