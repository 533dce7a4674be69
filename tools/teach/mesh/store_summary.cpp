#include "tools/teach/mesh/store_summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "drivers/datasets/bop_dataset.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"

namespace houghstream::teach {
namespace {

using store::PracticeRecord;

double fraction_of(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0.0;
}

std::string practice_words(const PracticeRecord& record) {
  if (record.shown == 0) return "not practised";
  return fmt::format("found in {:.0f} % of {} practice views", 100.0 * fraction_of(record.right, record.shown),
                     record.shown) +
         (record.wrong == 0 ? "" : fmt::format(", {} wrong poses", record.wrong));
}

/// Returns what practice says of an object, for its line in the list.
std::string practice_line(const std::optional<PracticeRecord>& record) {
  if (!record) return "unknown, hs-teach practise learns it";
  if (record->shown == 0) return "seen in none of its rooms";
  const store::Confusion confusion = store::most_frequent_confusion(*record);
  return fmt::format("recall {:.2f}, precision {:.3f} of {} views; {}", fraction_of(record->right, record->shown),
                     store::estimate_precision(record->right, record->wrong), record->shown,
                     confusion.name.empty()
                         ? "taken for nothing else"
                         : fmt::format("taken for {} in {:.1f} %", confusion.name, 100.0 * confusion.fraction));
}

std::string threshold_words(const char* measure, const store::PracticeCurve& curve, int shown, double precision) {
  if (curve.empty()) return fmt::format("{} as by default, as nothing was found", measure);
  const store::OperatingThreshold chosen = store::choose_threshold(curve, shown, precision);
  return fmt::format("{} {:.2f}, recall {:.2f}{}", measure, chosen.from, chosen.recall,
                     chosen.is_reached ? "" : fmt::format(" (not reached: {:.3f} is the best)", chosen.precision));
}

/// Returns the thresholds that an object needs for a precision, for its line in the list.
std::string precision_line(const PracticeRecord& record, double precision) {
  return fmt::format("{}; {}", threshold_words("score", record.scores, record.shown, precision),
                     threshold_words("quality", record.qualities, record.shown, precision));
}

OrderedJson threshold_json(const store::PracticeCurve& curve, int shown, double precision) {
  if (curve.empty()) return {};
  const store::OperatingThreshold chosen = store::choose_threshold(curve, shown, precision);
  return {{"from", chosen.from},
          {"precision", chosen.precision},
          {"recall", chosen.recall},
          {"reached", chosen.is_reached}};
}

OrderedJson practice_json(const std::optional<PracticeRecord>& record, std::optional<double> precision) {
  if (!record) return {};
  const store::Confusion confusion = store::most_frequent_confusion(*record);
  OrderedJson json;
  json["views"] = record->shown;
  json["recall"] = record->shown > 0 ? OrderedJson(fraction_of(record->right, record->shown)) : OrderedJson();
  json["precision"] = store::estimate_precision(record->right, record->wrong);
  json["taken_for"] = OrderedJson();
  if (!confusion.name.empty()) json["taken_for"] = {{"name", confusion.name}, {"fraction", confusion.fraction}};
  if (precision)
    json["at_precision"] = {{"wanted", *precision},
                            {"score", threshold_json(record->scores, record->shown, *precision)},
                            {"quality", threshold_json(record->qualities, record->shown, *precision)}};
  return json;
}

std::string known_symmetries(const store::StoredObject& object) {
  return object.shape_symmetry ? symmetry_words(*object.shape_symmetry) : "unknown, hs-teach practise finds them";
}

/// Returns the command as a person has to type it here: with its folder where that is not searched for programs.
std::string stream_program() {
  namespace fs = std::filesystem;
  const std::string name = "hs-stream";
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const char* searched = std::getenv("PATH");
  const std::string list = fmt::format(":{}:", searched == nullptr ? "" : searched);
  const bool is_searched = list.find(":" + folder.string() + ":") != std::string::npos;
  return is_searched || !fs::exists(folder / name, error) ? name : fs::proximate(folder / name, error).string();
}

}  // namespace

std::map<int, Eigen::Vector3d> object_sizes(const store::ObjectStore& store) {
  const BopModels models = read_bop_models(store.models_folder());
  std::map<int, Eigen::Vector3d> sizes;
  for (const store::StoredObject& object : store.objects) {
    const auto bounds = models.bounds.find(object.id);
    sizes[object.id] = bounds != models.bounds.end()
                           ? bounds->second.sizes()
                           : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()).eval();
  }
  return sizes;
}

std::string teaching_summary(const store::ObjectStore& store, const std::set<int>& taught) {
  const std::map<int, Eigen::Vector3d> sizes = object_sizes(store);
  std::string text = fmt::format("{}: {} object{}; look at {}\n", store.folder.string(), store.objects.size(),
                                 store.objects.size() == 1 ? "" : "s", store.contact_sheet().string());
  for (const store::StoredObject& object : store.objects) {
    if (taught.count(object.id) == 0) continue;
    text += fmt::format("  {:<24} {:<22} {}\n", object.name, size_words(sizes.at(object.id)),
                        practice_words(object.practice.value_or(PracticeRecord())));
  }
  return text + fmt::format("next: {} --source openni2 --objects {}\n", stream_program(), store.folder.string());
}

std::string store_text(const store::ObjectStore& store, std::optional<double> precision) {
  if (precision) store::check_precision(*precision, "precision");
  const std::map<int, Eigen::Vector3d> sizes = object_sizes(store);
  const bool has_groups = store.groups().size() > 1;
  std::string text;
  for (const store::StoredObject& object : store.objects) {
    text +=
        fmt::format("{:>6} {:<24} {:<22} {:>5} views, {}, {}; {}shape symmetries: {}; {}\n", object.id, object.name,
                    size_words(sizes.at(object.id)), object.views, object.attitudes,
                    object.coloured ? "coloured" : "colour unknown",
                    has_groups ? fmt::format("group {}; ", object.group) : "", known_symmetries(object), object.mesh);
    text += fmt::format("       practice: {}\n", practice_line(object.practice));
    if (precision && object.practice)
      text += fmt::format("       precision {}: {}\n", *precision, precision_line(*object.practice, *precision));
    for (const ObjectFrame& frame : object.frames) {
      const Eigen::Vector3d at = frame.T_object_frame.translation();
      const Eigen::Quaterniond q(frame.T_object_frame.linear());
      text += fmt::format("       frame {:<20} at {:g},{:g},{:g} m, rotation {:.4g},{:.4g},{:.4g},{:.4g}\n", frame.name,
                          at.x(), at.y(), at.z(), q.w(), q.x(), q.y(), q.z());
    }
  }
  return text;
}

OrderedJson store_json(const store::ObjectStore& store, std::optional<double> precision) {
  if (precision) store::check_precision(*precision, "precision");
  const std::map<int, Eigen::Vector3d> sizes = object_sizes(store);
  OrderedJson objects = OrderedJson::array();
  for (const store::StoredObject& object : store.objects) {
    const Eigen::Vector3d& size = sizes.at(object.id);
    OrderedJson entry;
    entry["id"] = object.id;
    entry["name"] = object.name;
    entry["size_m"] = size.allFinite() ? OrderedJson({size.x(), size.y(), size.z()}) : OrderedJson();
    entry["group"] = object.group;
    entry["views"] = object.views;
    entry["attitudes"] = object.attitudes;
    entry["coloured"] = object.coloured;
    entry["shape_symmetries"] =
        object.shape_symmetry ? OrderedJson(symmetry_words(*object.shape_symmetry)) : OrderedJson();
    entry["practice"] = practice_json(object.practice, precision);
    entry["frames"] = OrderedJson::object();
    for (const ObjectFrame& frame : object.frames) {
      const Eigen::Vector3d at = frame.T_object_frame.translation();
      const Eigen::Quaterniond q(frame.T_object_frame.linear());
      entry["frames"][frame.name] = {{"translation_m", {at.x(), at.y(), at.z()}},
                                     {"rotation", {q.w(), q.x(), q.y(), q.z()}}};
    }
    entry["mesh"] = object.mesh;
    objects.push_back(std::move(entry));
  }
  OrderedJson json;
  json["store"] = store.folder.string();
  json["contact_sheet"] = store.contact_sheet().string();
  json["objects"] = std::move(objects);
  return json;
}

}  // namespace houghstream::teach
