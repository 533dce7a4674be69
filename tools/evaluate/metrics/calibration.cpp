#include "tools/evaluate/metrics/calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace houghstream {
namespace {

constexpr int kBins = 10;
constexpr std::array<double, 4> kPrecisions = {0.90, 0.95, 0.98, 0.99};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<ReliabilityBin> bins_of(const std::vector<Prediction>& statements) {
  std::vector<ReliabilityBin> bins(kBins);
  for (int i = 0; i < kBins; ++i) bins[i] = {static_cast<double>(i) / kBins, static_cast<double>(i + 1) / kBins};
  for (const Prediction& statement : statements) {
    ReliabilityBin& bin = bins[std::clamp(static_cast<int>(statement.confidence * kBins), 0, kBins - 1)];
    ++bin.count;
    bin.mean_score += statement.confidence;
    bin.true_fraction += statement.is_true ? 1.0 : 0.0;
  }
  for (ReliabilityBin& bin : bins) {
    bin.mean_score = bin.count > 0 ? bin.mean_score / bin.count : kNaN;
    bin.true_fraction = bin.count > 0 ? bin.true_fraction / bin.count : kNaN;
  }
  return bins;
}

double expected_error(const std::vector<ReliabilityBin>& bins, int count) {
  double sum = 0.0;
  for (const ReliabilityBin& bin : bins) {
    if (bin.count > 0) sum += bin.count * std::abs(bin.mean_score - bin.true_fraction);
  }
  return count > 0 ? sum / count : kNaN;
}

/// Proposes a threshold. `ranked` is sorted, highest first. A threshold cannot divide equals.
ProposedThreshold propose(double precision, const std::vector<Prediction>& ranked, int could_be_true) {
  ProposedThreshold out{precision, std::nullopt, kNaN};
  int true_count = 0;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    true_count += ranked[i].is_true ? 1 : 0;
    const bool last_of_equals = i + 1 == ranked.size() || ranked[i + 1].confidence < ranked[i].confidence;
    if (!last_of_equals || true_count < precision * static_cast<double>(i + 1)) continue;
    out.score = ranked[i].confidence;
    out.recall = could_be_true > 0 ? static_cast<double>(true_count) / could_be_true : kNaN;
  }
  return out;
}

}  // namespace

Calibration calibrate(const std::vector<Prediction>& statements, int could_be_true) {
  Calibration out;
  out.count = static_cast<int>(statements.size());
  out.bins = bins_of(statements);
  out.ece = expected_error(out.bins, out.count);
  std::vector<Prediction> ranked = statements;
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Prediction& a, const Prediction& b) { return a.confidence > b.confidence; });
  for (const double precision : kPrecisions) out.proposed.push_back(propose(precision, ranked, could_be_true));
  return out;
}

}  // namespace houghstream
