#include "tools/studies/quality/quality_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pose/verification/quality_training.hpp"

namespace houghstream::quality {
namespace {

constexpr double kPriorPrecision = 10.0;  // precision of the prior, see fit_quality()
constexpr double kCorrectFraction = 0.98;
constexpr int kRoundSteps = 20;  // thresholds are multiples of one over this

std::vector<std::string> scenes_of(const std::vector<Example>& examples) {
  std::vector<std::string> scenes;
  for (const Example& example : examples) {
    if (std::find(scenes.begin(), scenes.end(), example.scene) == scenes.end()) scenes.push_back(example.scene);
  }
  return scenes;
}

int count_correct(const std::vector<Example>& examples) {
  return static_cast<int>(std::count_if(examples.begin(), examples.end(),
                                        [](const Example& example) { return example.is_correct_up_to_shape; }));
}

std::string to_braces(const QualityTerms& terms) {
  std::string text;
  for (const auto term : kQualityTerms) text += fmt::format("{}{:.2f}", text.empty() ? "" : ", ", terms.*term);
  return "{" + text + "}";
}

OrderedJson to_json(const Published& published) {
  return {{"poses", published.poses},
          {"right", published.correct},
          {"right_share", finite_or_null(published.correct_fraction())}};
}

OrderedJson to_json(const QualityTerms& terms) {
  OrderedJson out = OrderedJson::object();
  for (std::size_t i = 0; i < kQualityTerms.size(); ++i) out[kQualityTermNames[i]] = terms.*kQualityTerms[i];
  return out;
}

float round_quality(int step) {
  return static_cast<float>(step) / kRoundSteps;
}

}  // namespace

QualitySettings fit_quality(const std::vector<Example>& examples) {
  const int correct = count_correct(examples);
  require(correct > 0 && correct < static_cast<int>(examples.size()), "{} poses, {} of them right, expected both kinds",
          examples.size(), correct);
  std::vector<QualityExample> judged;
  judged.reserve(examples.size());
  for (const Example& example : examples) {
    judged.emplace_back();
    judged.back().terms = example.terms;
    judged.back().is_correct_up_to_shape = example.is_correct_up_to_shape;
  }
  return fit_quality_settings(judged, QualitySettings{}, kPriorPrecision);
}

std::vector<CheckedPose> check_by(const QualitySettings& settings, const std::vector<Example>& examples) {
  std::vector<CheckedPose> checked;
  checked.reserve(examples.size());
  for (const Example& example : examples) {
    checked.push_back({shape_quality(example.terms, settings), example.is_correct_up_to_shape});
  }
  return checked;
}

std::vector<CheckedPose> check_by_scene(const std::vector<Example>& examples, int parts) {
  const std::vector<std::string> scenes = scenes_of(examples);
  require(static_cast<int>(scenes.size()) >= parts,
          "poses of {} scenes, expected at least {} to judge each part by the others", scenes.size(), parts);
  std::vector<CheckedPose> checked;
  for (int part = 0; part < parts; ++part) {
    const auto is_judged = [&](const Example& example) {
      const auto at = std::find(scenes.begin(), scenes.end(), example.scene) - scenes.begin();
      return at % parts == part;
    };
    std::vector<Example> judged;
    std::vector<Example> others;
    std::partition_copy(examples.begin(), examples.end(), std::back_inserter(judged), std::back_inserter(others),
                        is_judged);
    const std::vector<CheckedPose> here = check_by(fit_quality(others), judged);
    checked.insert(checked.end(), here.begin(), here.end());
  }
  return checked;
}

double Published::correct_fraction() const {
  return poses > 0 ? static_cast<double>(correct) / poses : std::numeric_limits<double>::quiet_NaN();
}

Published published_from(const std::vector<CheckedPose>& checked, float minimum) {
  Published out;
  for (const CheckedPose& pose : checked) {
    if (pose.quality < minimum) continue;
    ++out.poses;
    out.correct += pose.is_correct ? 1 : 0;
  }
  return out;
}

std::optional<float> min_quality(const std::vector<CheckedPose>& checked, double correct_fraction) {
  for (int step = 1; step < kRoundSteps; ++step) {
    if (published_from(checked, round_quality(step)).correct_fraction() >= correct_fraction) return round_quality(step);
  }
  return std::nullopt;
}

Learnt learn_quality(const std::vector<Example>& examples) {
  Learnt learnt;
  learnt.scenes = static_cast<int>(scenes_of(examples).size());
  learnt.examples = static_cast<int>(examples.size());
  learnt.correct = count_correct(examples);
  learnt.settings = fit_quality(examples);
  learnt.checked = check_by_scene(examples, kMinScenes);
  const std::optional<float> minimum = min_quality(learnt.checked, kCorrectFraction);
  require(minimum.has_value(), "{} poses: from no quality are {:.0f} % of those in unseen scenes right",
          examples.size(), 100.0 * kCorrectFraction);
  learnt.settings.min_quality = *minimum;
  const QualitySettings in_use;
  learnt.in_use = published_from(check_by(in_use, examples), in_use.min_quality);
  return learnt;
}

std::string to_initialisers(const QualitySettings& settings) {
  return fmt::format(
      "double bias = {:.2f};\nQualityTerms weights = {};\nQualityTerms typical = {};\nfloat least = {:.2f}F;\n",
      settings.bias, to_braces(settings.weights), to_braces(settings.mean_of_correct), settings.min_quality);
}

OrderedJson to_json(const Learnt& learnt) {
  OrderedJson out = {{"scenes", learnt.scenes}, {"examples", learnt.examples}, {"right", learnt.correct}};
  out["bias"] = learnt.settings.bias;
  out["weights"] = to_json(learnt.settings.weights);
  out["typical"] = to_json(learnt.settings.mean_of_correct);
  out["least"] = std::round(static_cast<double>(learnt.settings.min_quality) * kRoundSteps) / kRoundSteps;
  out["in_use"] = to_json(learnt.in_use);
  out["published"] = OrderedJson::array();
  for (int step = 1; step < kRoundSteps; ++step) {
    OrderedJson row = {{"from", static_cast<double>(step) / kRoundSteps}};
    row.update(to_json(published_from(learnt.checked, round_quality(step))));
    out["published"].push_back(row);
  }
  return out;
}

}  // namespace houghstream::quality
