#include "drivers/store/practice_record.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/checks.hpp"

namespace houghstream::store {
namespace {

constexpr double kStepsOfOne = 1e4;

double rounded_down(double value) {
  return std::floor(value * kStepsOfOne) / kStepsOfOne;
}

/// Returns whether the lower of two adjacent steps has at least the fraction of right ones of the upper one.
bool violates_order(const PracticeStep& upper, const PracticeStep& lower) {
  return static_cast<long>(lower.right) * (upper.right + upper.wrong) >=
         static_cast<long>(upper.right) * (lower.right + lower.wrong);
}

PracticeStep pooled(const PracticeStep& upper, const PracticeStep& lower) {
  return {lower.from, upper.right + lower.right, upper.wrong + lower.wrong};
}

/// A list of values, and where a row has its own.
template <typename Row, typename Value>
struct Column {
  const char* name;
  Value Row::*value;
};

/// The three lists of one length that hold rows.
template <typename Row>
struct Columns {
  Column<Row, double> bound;
  Column<Row, int> first;   ///< counts
  Column<Row, int> second;  ///< counts
};

constexpr Columns<PracticeStep> kSteps{
    {"from", &PracticeStep::from}, {"right", &PracticeStep::right}, {"wrong", &PracticeStep::wrong}};
constexpr Columns<PracticeBin> kBins{
    {"to", &PracticeBin::to}, {"shown", &PracticeBin::shown}, {"found", &PracticeBin::found}};

template <typename Row>
OrderedJson columns_of(const std::vector<Row>& rows, const Columns<Row>& columns) {
  const auto values_of = [&](const auto& column) {
    OrderedJson values = OrderedJson::array();
    for (const Row& row : rows) values.push_back(row.*column.value);
    return values;
  };
  OrderedJson json;
  json[columns.bound.name] = values_of(columns.bound);
  json[columns.first.name] = values_of(columns.first);
  json[columns.second.name] = values_of(columns.second);
  return json;
}

template <typename Row>
std::vector<Row> read_columns(const nlohmann::json& json, const char* key, const Columns<Row>& columns,
                              const std::string& where) {
  const std::string place = fmt::format("{} '{}'", where, key);
  require(json.contains(key) && json.at(key).is_object(), "{} is missing, expected lists of counts", place);
  const nlohmann::json& lists = json.at(key);
  require_known_names(lists, {columns.bound.name, columns.first.name, columns.second.name}, place);
  const auto list = lists.find(columns.bound.name);
  require(list != lists.end() && list->is_array(), "{}: no '{}', expected a list of numbers", place,
          columns.bound.name);
  const std::vector<double> bounds = json_numbers(lists, columns.bound.name, list->size(), place);
  std::vector<Row> rows(bounds.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].*columns.bound.value = bounds[i];
  for (const Column<Row, int>& column : {columns.first, columns.second}) {
    const std::vector<double> counts = json_numbers(lists, column.name, rows.size(), place);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      require(counts[i] >= 0.0 && counts[i] < 1e9 && counts[i] == std::floor(counts[i]), "{}: {}, expected a count",
              place, counts[i]);
      rows[i].*column.value = static_cast<int>(counts[i]);
    }
  }
  return rows;
}

PracticeCurve read_curve(const nlohmann::json& json, const char* key, const std::string& where) {
  PracticeCurve curve;
  for (const PracticeStep& step : read_columns(json, key, kSteps, where)) {
    const bool falls = curve.empty() ? step.from <= 1.0 : step.from < curve.back().from;
    const bool grows = curve.empty() || (step.right >= curve.back().right && step.wrong >= curve.back().wrong);
    require(step.from >= 0.0 && falls && grows && step.right + step.wrong > 0,
            "{} '{}': {} right and {} wrong from {} on, expected thresholds that fall from 1 to 0 and counts that grow",
            where, key, step.right, step.wrong, step.from);
    curve.push_back(step);
  }
  return curve;
}

std::vector<PracticeBin> read_bins(const nlohmann::json& json, const char* key, const std::string& where) {
  std::vector<PracticeBin> bins;
  for (const PracticeBin& bin : read_columns(json, key, kBins, where)) {
    require(bin.to > (bins.empty() ? 0.0 : bins.back().to) && bin.found <= bin.shown,
            "{} '{}': {} of {} found up to {}, expected ends that grow and at most as many found as shown", where, key,
            bin.found, bin.shown, bin.to);
    bins.push_back(bin);
  }
  return bins;
}

int read_count(const nlohmann::json& json, const char* key, const std::string& where) {
  const int count = json_integer(json, key, where);
  require(count >= 0, "{}: '{}' is {}, expected a count", where, key, count);
  return count;
}

}  // namespace

void check_precision(double precision, const std::string& where) {
  require(precision >= 0.0 && precision <= kMaxPrecision, "{} {}, expected 0 to {}", where, precision, kMaxPrecision);
}

PracticeCurve make_practice_curve(std::vector<JudgedValue> values) {
  for (JudgedValue& it : values) it.value = rounded_down(it.value);
  std::sort(values.begin(), values.end(), [](const JudgedValue& a, const JudgedValue& b) { return a.value > b.value; });
  PracticeCurve blocks;
  for (std::size_t i = 0; i < values.size();) {
    PracticeStep block{values[i].value, 0, 0};
    for (; i < values.size() && values[i].value == block.from; ++i) ++(values[i].is_right ? block.right : block.wrong);
    for (; !blocks.empty() && violates_order(blocks.back(), block); blocks.pop_back())
      block = pooled(blocks.back(), block);
    blocks.push_back(block);
  }
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    blocks[i].right += blocks[i - 1].right;
    blocks[i].wrong += blocks[i - 1].wrong;
  }
  return blocks;
}

double estimate_precision(int right, int wrong) {
  constexpr double kPrior = 0.5;
  return (right + kPrior) / (right + wrong + 2.0 * kPrior);
}

OperatingThreshold choose_threshold(const PracticeCurve& curve, int shown, double precision) {
  require(!curve.empty(), "no detection of an object in its practice, expected some to choose a threshold");
  OperatingThreshold best;
  OperatingThreshold chosen;
  for (const PracticeStep& step : curve) {
    const double recall = shown > 0 ? std::min(1.0, static_cast<double>(step.right) / shown) : 0.0;
    OperatingThreshold here{step.from, estimate_precision(step.right, step.wrong), recall, false};
    here.is_reached = here.precision >= precision;
    if (here.is_reached) chosen = here;  // thresholds fall
    if (here.precision >= best.precision) best = here;
  }
  return chosen.is_reached ? chosen : best;
}

Confusion most_frequent_confusion(const PracticeRecord& record) {
  Confusion most;
  int count = 0;
  for (const auto& [name, times] : record.taken_for) {
    if (times <= count || record.shown == 0) continue;
    count = times;
    most = {name, static_cast<double>(times) / record.shown};
  }
  return most;
}

OrderedJson to_json(const PracticeRecord& record) {
  OrderedJson json;
  json["shown"] = record.shown;
  json["right"] = record.right;
  json["wrong"] = record.wrong;
  json["score"] = columns_of(record.scores, kSteps);
  json["quality"] = columns_of(record.qualities, kSteps);
  json["taken_for"] = OrderedJson::object();
  for (const auto& [name, times] : record.taken_for) json["taken_for"][name] = times;
  json["by_distance_m"] = columns_of(record.by_distance, kBins);
  json["by_visible"] = columns_of(record.by_visible, kBins);
  return json;
}

PracticeRecord practice_from_json(const nlohmann::json& json, const std::string& where) {
  require(json.is_object(), "{} is {}, expected counts by name", where, json_text(json));
  require_known_names(json, {"shown", "right", "wrong", "score", "quality", "taken_for", "by_distance_m", "by_visible"},
                      where);
  PracticeRecord record;
  record.shown = read_count(json, "shown", where);
  record.right = read_count(json, "right", where);
  record.wrong = read_count(json, "wrong", where);
  record.scores = read_curve(json, "score", where);
  record.qualities = read_curve(json, "quality", where);
  require(json.contains("taken_for") && json.at("taken_for").is_object(), "{}: no 'taken_for', expected counts by name",
          where);
  const nlohmann::json& taken = json.at("taken_for");
  for (const auto& [name, times] : taken.items()) record.taken_for[name] = read_count(taken, name.c_str(), where);
  record.by_distance = read_bins(json, "by_distance_m", where);
  record.by_visible = read_bins(json, "by_visible", where);
  return record;
}

}  // namespace houghstream::store
