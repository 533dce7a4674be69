#include "pose/verification/quality_training.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "pipeline/base/logistic_regression.hpp"

namespace houghstream {
namespace {

constexpr int kWeights = 1 + static_cast<int>(kQualityTerms.size());  // the bias first

using Weights = Eigen::Matrix<double, kWeights, 1>;

Weights to_vector(double bias, const QualityTerms& terms) {
  Weights out;
  out[0] = bias;
  for (std::size_t i = 0; i < kQualityTerms.size(); ++i)
    out[static_cast<Eigen::Index>(i) + 1] = terms.*kQualityTerms[i];
  return out;
}

/// Returns the mean terms of correct poses; those of `otherwise` where there are none.
QualityTerms average_correct(const std::vector<QualityExample>& examples, const QualityTerms& default_terms) {
  QualityTerms sum;
  int count = 0;
  for (const QualityExample& example : examples) {
    if (!example.is_correct_up_to_shape) continue;
    ++count;
    for (const auto term : kQualityTerms) sum.*term += example.terms.*term;
  }
  if (count == 0) return default_terms;
  for (const auto term : kQualityTerms) sum.*term /= count;
  return sum;
}

using ExamplesByName = std::map<std::string, std::vector<QualityExample>>;

// Precision of the prior of the objects' common weights, since few poses of one object do not determine its weights.
constexpr double kPriorPrecision = 10.0;
// Precision of the prior by the default numbers, since a store's few objects do not determine them either.
constexpr double kCommonPrecision = 5.0;

std::map<std::string, QualitySettings> fit_each(const ExamplesByName& examples) {
  std::vector<QualityExample> all;
  for (const auto& [name, class_examples] : examples)
    all.insert(all.end(), class_examples.begin(), class_examples.end());
  const QualitySettings common = fit_quality_settings(all, QualitySettings{}, kCommonPrecision);
  std::map<std::string, QualitySettings> fitted;
  for (const auto& [name, class_examples] : examples)
    fitted[name] = fit_quality_settings(class_examples, common, kPriorPrecision);
  return fitted;
}

ExamplesByName examples_of_fold(int fold, const ExamplesByName& examples) {
  ExamplesByName out;
  for (const auto& [name, class_examples] : examples) {
    std::vector<QualityExample>& fold_examples = out[name];
    std::copy_if(class_examples.begin(), class_examples.end(), std::back_inserter(fold_examples),
                 [fold](const QualityExample& example) { return example.fold == fold; });
  }
  return out;
}

/// Returns the examples, each with the quality that is learnt from the other fold.
std::map<std::string, std::vector<PresenceExample>> presence_examples(const ExamplesByName& examples) {
  std::map<std::string, std::vector<PresenceExample>> out;
  for (const int fold : {0, 1}) {
    const std::map<std::string, QualitySettings> fitted = fit_each(examples_of_fold(1 - fold, examples));
    for (const auto& [name, class_examples] : examples_of_fold(fold, examples)) {
      for (const QualityExample& example : class_examples)
        out[name].push_back({example.score, shape_quality(example.terms, fitted.at(name)), example.is_present});
    }
  }
  return out;
}

}  // namespace

TextureSettings fit_texture_settings(const std::vector<QualityExample>& examples, const TextureSettings& prior,
                                     double precision) {
  // Margins are clamped here, so that a few extreme examples do not dominate those near the decision boundary.
  constexpr double kMax = 8.0;
  std::vector<LogisticExample<2>> labelled;
  for (const QualityExample& example : examples) {
    if (!example.is_correct_up_to_shape || !example.texture_margin) continue;
    labelled.push_back({{1.0, std::clamp(*example.texture_margin, -kMax, kMax)}, example.is_correct});
  }
  const Eigen::Vector2d weights = fit_logistic<2>(labelled, {{prior.bias, prior.margin_weight}, precision});
  return {weights[0], weights[1]};
}

QualitySettings fit_quality_settings(const std::vector<QualityExample>& examples, const QualitySettings& prior,
                                     double precision) {
  std::vector<LogisticExample<kWeights>> labelled;
  labelled.reserve(examples.size());
  for (const QualityExample& example : examples) {
    labelled.push_back({to_vector(1.0, example.terms), example.is_correct_up_to_shape});
    // The pair only shows which texture is correct, not how probable that is: all other terms are equal and cancel.
    if (example.with_swapped_texture)
      labelled.push_back({to_vector(1.0, example.terms) - to_vector(1.0, *example.with_swapped_texture), true});
  }
  // Scenes from which nothing is taken away show hardly any free-space violation at poses that were found, so that
  // their examples say nothing about this weight.
  constexpr int kFreeSpaceViolation = 2;
  static_assert(kQualityTerms[kFreeSpaceViolation - 1] == &QualityTerms::free_space_violation);
  const LogisticPrior<kWeights> gaussian_prior{to_vector(prior.bias, prior.weights), precision, kFreeSpaceViolation};
  const Weights weights = fit_logistic<kWeights>(labelled, gaussian_prior);
  QualitySettings settings = prior;
  settings.bias = weights[0];
  for (std::size_t i = 0; i < kQualityTerms.size(); ++i)
    settings.weights.*kQualityTerms[i] = weights[static_cast<Eigen::Index>(i) + 1];
  settings.mean_of_correct = average_correct(examples, prior.mean_of_correct);
  return settings;
}

std::map<std::string, std::vector<float>> cross_fitted_qualities(const ExamplesByName& examples) {
  const std::array<std::map<std::string, QualitySettings>, 2> fitted_without = {
      fit_each(examples_of_fold(1, examples)), fit_each(examples_of_fold(0, examples))};
  std::map<std::string, std::vector<float>> qualities;
  for (const auto& [name, class_examples] : examples) {
    std::vector<float>& class_qualities = qualities[name];
    for (const QualityExample& example : class_examples)
      class_qualities.push_back(
          shape_quality(example.terms, fitted_without[static_cast<std::size_t>(example.fold)].at(name)));
  }
  return qualities;
}

std::map<std::string, QualitySettings> learn_qualities(const ExamplesByName& examples) {
  std::map<std::string, QualitySettings> learnt = fit_each(examples);
  const std::map<std::string, std::vector<PresenceExample>> presence = presence_examples(examples);
  std::vector<PresenceExample> all;
  for (const auto& [name, class_examples] : presence)
    all.insert(all.end(), class_examples.begin(), class_examples.end());
  const PresenceSettings common = fit_presence(all, PresenceSettings{}, 1.0);
  for (const auto& [name, class_examples] : presence)
    learnt.at(name).presence = fit_presence(class_examples, common, kPriorPrecision);
  std::vector<QualityExample> all_examples;
  for (const auto& [name, class_examples] : examples)
    all_examples.insert(all_examples.end(), class_examples.begin(), class_examples.end());
  const TextureSettings common_texture = fit_texture_settings(all_examples, TextureSettings{}, kCommonPrecision);
  for (const auto& [name, class_examples] : examples)
    learnt.at(name).texture = fit_texture_settings(class_examples, common_texture, kPriorPrecision);
  return learnt;
}

}  // namespace houghstream
