#include "drivers/store/precision_thresholds.hpp"

#include <fmt/ranges.h>

#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"

namespace houghstream::store {
namespace {

void require_practice(const ObjectStore& store) {
  std::vector<std::string> unknown;
  for (const StoredObject& object : store.objects) {
    if (!object.practice) unknown.push_back(object.name);
  }
  require(unknown.empty(),
          "{}: no 'practice' of {}, expected one for a precision to choose from: 'hs-teach practise {}' learns it",
          store.json_file().string(), fmt::join(unknown, ", "), store.folder.string());
}

}  // namespace

std::map<std::string, float> thresholds_for_precision(const ObjectStore& store, PracticeMeasure measure,
                                                      double precision) {
  check_precision(precision, "precision");
  require_practice(store);
  const char* word = measure == PracticeMeasure::kScore ? "score" : "quality";
  std::map<std::string, float> thresholds;
  for (const StoredObject& object : store.objects) {
    const PracticeRecord& record = *object.practice;
    const PracticeCurve& curve = measure == PracticeMeasure::kScore ? record.scores : record.qualities;
    if (curve.empty()) {
      log_warning("{}: not found in practice, expected some detections for precision {}: its {} is as by default",
                  object.name, precision, word);
      continue;
    }
    const OperatingThreshold chosen = choose_threshold(curve, record.shown, precision);
    thresholds[object.name] = static_cast<float>(chosen.from);
    if (!chosen.is_reached)
      log_warning("{}: precision {:.3f} from {} {:.2f} on is the best in practice, expected {}: that is taken",
                  object.name, chosen.precision, word, chosen.from, precision);
  }
  return thresholds;
}

}  // namespace houghstream::store
