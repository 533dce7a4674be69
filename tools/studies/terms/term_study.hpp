#pragma once

#include <map>
#include <string>
#include <vector>

#include "detector/detection_settings.hpp"
#include "detector/evidence/hypothesis_scoring.hpp"
#include "drivers/files/json_file.hpp"
#include "tools/evaluate/metrics/evaluated_frame.hpp"

// This study shows which terms of the score lower the scores of true objects, and which raise those of others. It
// compares groups of scenes, for instance of rendered rooms like those in which the weights were learnt, and of a
// camera.

namespace houghstream::terms {

struct StudyRules {
  double min_visible = 0.5;                    ///< minimum visible fraction of a counted object
  float score = EvidenceSettings{}.threshold;  ///< minimum score of a reported object
  float false_score = 0.3F;                    ///< minimum score of a false candidate
  SuppressionSettings suppression;
};

/// Holds a candidate with its terms weighted by its class.
struct Sample {
  std::string class_name;
  float score = 0.0F;
  ScoreTerms terms{};
  ScoreTerms contributions{};  ///< term times weight; their sum is the score's log odds
};

/// Detections in a group of scenes.
struct Group {
  std::string name;
  int frames = 0;
  int objects = 0;                      ///< true ones that are visible enough, of classes that the forest knows
  int with_candidate = 0;               ///< objects of which a candidate overlaps the visible box by half or more
  std::vector<Sample> true_positives;   ///< the strongest such candidate of each object
  std::vector<Sample> false_positives;  ///< false candidates after suppression, from StudyRules::false_score on
};

using ModelsByClass = std::map<std::string, ScoreModel>;

/// Adds a frame: its true objects and all candidates in it. Those that are false are so as hs-evaluate judges.
void add_frame(EvaluatedFrame truth, const std::vector<ScoredHypothesis>& candidates, const ModelsByClass& models,
               const StudyRules& rules, Group& group);

/// Summarises one term over many candidates; NaN where there are none.
struct TermFigures {
  std::string term;
  double median = 0.0;
  double mean = 0.0;
  double contribution = 0.0;         ///< mean
  double contribution_median = 0.0;  ///< median
};

/// Returns the figures in the order of kScoreTermList.
std::vector<TermFigures> term_figures(const std::vector<Sample>& samples);

/// Terms of the true ones, whose mean contributions lie furthest below those of the first group, lowest first; not the
/// constant.
struct TermShift {
  std::string term;
  double shift = 0.0;
};
std::vector<TermShift> shifts_between(const std::vector<Sample>& first, const std::vector<Sample>& other);

/// Returns a table for people: a row for each term, for each group the median of the term and the mean of its
/// contribution, for true and for false ones, and below it the terms that lower each group's true ones in comparison
/// with the first group's.
std::string table(const std::vector<Group>& groups, const StudyRules& rules);

/// Returns {GROUP: {"frames", "objects", "with_candidate", "reported", "score_median", "true": {"count", TERM:
/// {"median", "mean", "contribution", "contribution_median"}}, "false": {...}}}.
OrderedJson to_json(const std::vector<Group>& groups, const StudyRules& rules);

}  // namespace houghstream::terms
