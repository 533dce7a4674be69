#include "tools/studies/speed/speed_bench.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/targets.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "detector/baseline/gall_profile.hpp"
#include "detector/forest/forest_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/bus/percentiles.hpp"
#include "tools/common/rounded.hpp"
#include "tools/finder/search_options.hpp"
#include "tools/studies/baseline/study_search.hpp"

namespace houghstream {
namespace {

struct Wishes {
  SearchOptions search;
  int trees = 0;  // 0 = all
  bool reference = false;
};

double positive_number(const std::string& text, const std::string& of) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc() && end == text.data() + text.size() && value > 0.0,
          "{}: '{}', expected a number above 0", of, text);
  return value;
}

int positive_count(const std::string& text, const std::string& of) {
  const double value = positive_number(text, of);
  require(value == static_cast<int>(value), "{}: '{}', expected a whole number", of, text);
  return static_cast<int>(value);
}

float fraction(const std::string& text, const std::string& of) {
  float value = 0.0F;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc() && end == text.data() + text.size() && value >= 0.0F && value <= 1.0F,
          "{}: '{}', expected a number from 0 to 1", of, text);
  return value;
}

std::int64_t instruction_set(const std::string& name) {
  std::vector<std::string> known;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    known.emplace_back(hwy::TargetName(target));
    if (known.back() == name) return target;
  }
  fail("instruction set '{}', expected one that this processor has: {}", name, fmt::join(known, ", "));
}

void grant(const std::string& wish, const std::string& text, Wishes& wishes, BenchmarkedDetector& contender) {
  const std::size_t equals = std::min(wish.find('='), wish.size());
  const std::string name = wish.substr(0, equals);
  const std::string value = wish.substr(std::min(equals + 1, wish.size()));
  if (wish == "reference") {
    wishes.reference = true;
  } else if (name == "threads") {
    wishes.search.threads = positive_count(value, text);
  } else if (name == "trees") {
    wishes.trees = positive_count(value, text);
  } else if (name == "frames") {
    contender.frames = static_cast<std::size_t>(positive_count(value, text));
  } else if (name == "scale") {
    contender.image_scale = positive_number(value, text);
  } else if (name == "threshold") {
    wishes.search.threshold = fraction(value, text);
  } else if (name == "min-mass") {
    wishes.search.min_mass_fraction = fraction(value, text);
  } else if (name == "set") {
    contender.instruction_set = instruction_set(value);
  } else {
    fail("{}: '{}', expected threads=N, trees=N, frames=N, scale=X, threshold=X, min-mass=X, set=NAME or reference",
         text, wish);
  }
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

BenchmarkedDetector parse_contender(const std::string& text) {
  std::istringstream parts(text);
  std::string named_forest;
  std::getline(parts, named_forest, ',');
  const std::size_t equals = named_forest.find('=');
  require(equals != std::string::npos && equals > 0, "detector '{}', expected NAME=FOREST", text);
  BenchmarkedDetector contender;
  contender.name = named_forest.substr(0, equals);
  Wishes wishes;
  for (std::string wish; std::getline(parts, wish, ',');) grant(wish, text, wishes, contender);
  Forest forest = load_forest(named_forest.substr(equals + 1));
  const auto trees = static_cast<std::size_t>(wishes.trees);
  require(trees <= forest.roots.size(), "{}: the forest has {} trees", text, forest.roots.size());
  if (trees > 0) forest.roots.resize(trees);
  const DetectionSettings settings = wishes.search.change(baseline::detection_settings_of(forest));
  contender.detect = study_search(std::move(forest), settings, wishes.reference);
  return contender;
}

RgbdFrame resized_frame(const RgbdFrame& frame, double scale) {
  if (scale == 1.0) return frame;
  RgbdFrame out;
  out.id = frame.id;
  out.camera = frame.camera.scaled(scale);
  const cv::Size size(out.camera.width, out.camera.height);
  cv::resize(frame.colour, out.colour, size, 0.0, 0.0, scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::resize(frame.depth, out.depth, size, 0.0, 0.0, cv::INTER_NEAREST);
  return out;
}

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
