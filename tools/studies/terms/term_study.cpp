#include "tools/studies/terms/term_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "detector/evidence/suppression.hpp"
#include "pipeline/bus/percentiles.hpp"
#include "tools/common/rounded.hpp"
#include "tools/evaluate/metrics/detection_metrics.hpp"

namespace houghstream::terms {
namespace {

Sample sample_of(const ScoredHypothesis& candidate, const ScoreModel& model) {
  Sample sample{candidate.detection.class_name, candidate.detection.score, score_terms(candidate.evidence), {}};
  for (const auto term : kScoreTermList) sample.contributions.*term = sample.terms.*term * model.weights.*term;
  return sample;
}

/// The strongest candidate whose box is the object's.
const ScoredHypothesis* strongest_of(const NamedObject& object, const std::vector<ScoredHypothesis>& candidates) {
  const ScoredHypothesis* best = nullptr;
  for (const ScoredHypothesis& candidate : candidates) {
    const Detection& detection = candidate.detection;
    if (detection.class_name != object.class_name) continue;
    if (box_iou(detection.box_px, cv::Rect2f(object.truth.box_visible_px)) < DetectionRules{}.min_iou) continue;
    if (best == nullptr || detection.score > best->detection.score) best = &candidate;
  }
  return best;
}

/// Returns the detections without a threshold; each has its candidate's number as vote_count.
Detections numbered_detections(const std::vector<ScoredHypothesis>& candidates, const SuppressionSettings& settings) {
  std::vector<Detection> all;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    all.push_back(candidates[i].detection);
    all.back().vote_count = static_cast<int>(i);
  }
  return {{}, suppress_overlaps(std::move(all), settings), {}};
}

std::vector<double> values_of(const std::vector<Sample>& samples, const std::function<float(const Sample&)>& value) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const Sample& sample : samples) values.push_back(static_cast<double>(value(sample)));
  return values;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double median_score(const std::vector<Sample>& samples) {
  return percentile(values_of(samples, [](const Sample& sample) { return sample.score; }), 50);
}

int count_reported(const Group& group, const StudyRules& rules) {
  return static_cast<int>(std::count_if(group.true_positives.begin(), group.true_positives.end(),
                                        [&](const Sample& sample) { return sample.score >= rules.score; }));
}

double log_odds(const std::vector<TermFigures>& figures) {
  double sum = 0.0;
  for (const TermFigures& term : figures) sum += term.contribution;
  return sum;
}

std::string cell(double value, int width) {
  return std::isfinite(value) ? fmt::format("{:>{}.2f}", value, width) : fmt::format("{:>{}}", "-", width);
}

std::string header(const std::vector<Group>& groups) {
  std::string text = fmt::format("{:<28}", "");
  for (const Group& group : groups) text += fmt::format("{:>28}", group.name);
  text += fmt::format("\n{:<28}", "median, contribution");
  for (std::size_t i = 0; i < groups.size(); ++i) text += fmt::format("{:>14}{:>14}", "true", "false");
  return text + "\n";
}

std::string counts(const std::vector<Group>& groups, const StudyRules& rules) {
  std::string text;
  const auto add = [&](const std::string& name, const auto& of_group) {
    text += fmt::format("{:<28}", name);
    for (const Group& group : groups) text += of_group(group);
    text += "\n";
  };
  add("frames", [](const Group& group) { return fmt::format("{:>14}{:>14}", group.frames, ""); });
  add("objects", [](const Group& group) { return fmt::format("{:>14}{:>14}", group.objects, ""); });
  add("with a candidate", [](const Group& group) { return fmt::format("{:>14}{:>14}", group.with_candidate, ""); });
  add(fmt::format("from score {:.2f} / {:.2f} on", rules.score, rules.false_score), [&](const Group& group) {
    return fmt::format("{:>14}{:>14}", count_reported(group, rules), group.false_positives.size());
  });
  add("score", [](const Group& group) {
    return cell(median_score(group.true_positives), 14) + cell(median_score(group.false_positives), 14);
  });
  return text;
}

OrderedJson number(double value) {
  return finite_or_null(rounded(value, 4));
}

OrderedJson figures_json(const std::vector<Sample>& samples) {
  OrderedJson json = {{"count", samples.size()}};
  for (const TermFigures& figures : term_figures(samples)) {
    json[figures.term] = {{"median", number(figures.median)},
                          {"mean", number(figures.mean)},
                          {"contribution", number(figures.contribution)},
                          {"contribution_median", number(figures.contribution_median)}};
  }
  return json;
}

}  // namespace

void add_frame(EvaluatedFrame truth, const std::vector<ScoredHypothesis>& candidates, const ModelsByClass& models,
               const StudyRules& rules, Group& group) {
  ++group.frames;
  for (const NamedObject& object : truth.objects) {
    const auto model = models.find(object.class_name);
    if (model == models.end() || object.truth.visible_fraction < rules.min_visible) continue;
    ++group.objects;
    const ScoredHypothesis* found = strongest_of(object, candidates);
    if (found == nullptr) continue;
    ++group.with_candidate;
    group.true_positives.push_back(sample_of(*found, model->second));
  }
  truth.detections = numbered_detections(candidates, rules.suppression);
  for (const auto& [name, model] : models) {
    for (const MatchedDetection& judged : match_detections({truth}, name, DetectionRules{})) {
      if (judged.outcome != MatchOutcome::kFalsePositive || judged.score < rules.false_score) continue;
      const int number = truth.detections->detections[judged.index].vote_count;
      group.false_positives.push_back(sample_of(candidates[static_cast<std::size_t>(number)], model));
    }
  }
}

std::vector<TermFigures> term_figures(const std::vector<Sample>& samples) {
  std::vector<TermFigures> all;
  for (std::size_t i = 0; i < kScoreTerms; ++i) {
    const auto term = kScoreTermList[i];
    const std::vector<double> terms = values_of(samples, [&](const Sample& sample) { return sample.terms.*term; });
    const std::vector<double> contributions =
        values_of(samples, [&](const Sample& sample) { return sample.contributions.*term; });
    TermFigures& figures = all.emplace_back();
    figures.term = kScoreTermNames[i];
    figures.median = percentile(terms, 50);
    figures.mean = mean_of(terms);
    figures.contribution = mean_of(contributions);
    figures.contribution_median = percentile(contributions, 50);
  }
  return all;
}

std::vector<TermShift> shifts_between(const std::vector<Sample>& first, const std::vector<Sample>& other) {
  std::vector<TermShift> shifts;
  if (first.empty() || other.empty()) return shifts;
  const std::vector<TermFigures> there = term_figures(first);
  const std::vector<TermFigures> here = term_figures(other);
  for (std::size_t i = 1; i < kScoreTerms; ++i)
    shifts.push_back({kScoreTermNames[i], here[i].contribution - there[i].contribution});
  std::stable_sort(shifts.begin(), shifts.end(),
                   [](const TermShift& a, const TermShift& b) { return a.shift < b.shift; });
  return shifts;
}

std::string table(const std::vector<Group>& groups, const StudyRules& rules) {
  std::string text = header(groups) + counts(groups, rules);
  std::vector<std::vector<TermFigures>> columns;
  for (const Group& group : groups) {
    columns.push_back(term_figures(group.true_positives));
    columns.push_back(term_figures(group.false_positives));
  }
  for (std::size_t i = 0; i < kScoreTerms; ++i) {
    text += fmt::format("{:<28}", kScoreTermNames[i]);
    for (const std::vector<TermFigures>& column : columns)
      text += cell(column[i].median, 7) + cell(column[i].contribution, 7);
    text += "\n";
  }
  text += fmt::format("{:<28}", "sum: log odds of the score");
  for (const std::vector<TermFigures>& column : columns) text += cell(log_odds(column), 14);
  text += "\n";
  constexpr std::size_t kRecentFrames = 6;
  for (std::size_t i = 1; i < groups.size(); ++i) {
    text += fmt::format("true ones of {} against {}:", groups[i].name, groups[0].name);
    const std::vector<TermShift> shifts = shifts_between(groups[0].true_positives, groups[i].true_positives);
    for (std::size_t k = 0; k < std::min(kRecentFrames, shifts.size()); ++k)
      text += fmt::format(" {} {:+.2f}", shifts[k].term, shifts[k].shift);
    text += "\n";
  }
  return text;
}

OrderedJson to_json(const std::vector<Group>& groups, const StudyRules& rules) {
  OrderedJson json = OrderedJson::object();
  for (const Group& group : groups) {
    json[group.name] = {{"frames", group.frames},
                        {"objects", group.objects},
                        {"with_candidate", group.with_candidate},
                        {"reported", count_reported(group, rules)},
                        {"score_median", number(median_score(group.true_positives))},
                        {"true", figures_json(group.true_positives)},
                        {"false", figures_json(group.false_positives)}};
  }
  return json;
}

}  // namespace houghstream::terms
