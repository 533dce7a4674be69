#include "tools/teach/mesh/store_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/html_text.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"
#include "tools/teach/mesh/store_summary.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using store::PracticeBin;
using store::PracticeCurve;
using store::PracticeRecord;
using store::StoredObject;

constexpr const char* kGenerator = "<meta name=\"generator\" content=\"hs-teach report\">";

constexpr const char* kStyle = R"(<style>
:root { color-scheme: light dark; --line: #8884; --score: #1769aa; --quality: #b3541e; }
@media (prefers-color-scheme: dark) { :root { --score: #6ab7f5; --quality: #f0a06a; } }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 78rem; margin: 1.5rem auto; padding: 0 1rem; }
table { border-collapse: collapse; } th, td { padding: .25rem .7rem; text-align: right; border-bottom: 1px solid var(--line); }
th:first-child, td:first-child, .words { text-align: left; } .wide { overflow-x: auto; }
section { border-top: 2px solid var(--line); margin-top: 1.5rem; } img { max-width: 100%; }
.parts { display: flex; flex-wrap: wrap; gap: 1.5rem; align-items: flex-start; } figure { margin: 0; }
svg text { font-size: 11px; fill: currentColor; } .axis { stroke: var(--line); }
.score { stroke: var(--score); fill: none; stroke-width: 2; } .quality { stroke: var(--quality); fill: none; stroke-width: 2; }
.score-key { color: var(--score); } .quality-key { color: var(--quality); }
</style>
)";

/// Encodes bytes for a data URL (RFC 4648, section 4).
std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[bits >> (18U - 6U * k) & 63U] : '=';
  }
  return text;
}

std::string percent(int part, int whole) {
  return whole > 0 ? fmt::format("{:.0f} %", 100.0 * part / whole) : "–";
}

/// Returns the cells of an object's row that practice fills.
std::string practice_cells(const std::optional<PracticeRecord>& record) {
  if (!record) return "<td colspan=\"4\" class=\"words\">unknown, hs-teach practise learns it</td>";
  if (record->shown == 0) return "<td colspan=\"4\" class=\"words\">seen in none of its practice rooms</td>";
  const store::Confusion confusion = store::most_frequent_confusion(*record);
  const std::string taken = confusion.name.empty()
                                ? "–"
                                : fmt::format("{} ({:.1f} %)", escape_html(confusion.name), 100.0 * confusion.fraction);
  return fmt::format("<td>{}</td><td>{}</td><td>{:.1f} %</td><td class=\"words\">{}</td>", record->shown,
                     percent(record->right, record->shown),
                     100.0 * store::estimate_precision(record->right, record->wrong), taken);
}

std::string overview(const store::ObjectStore& store, const StoreReportParts& parts) {
  std::string page =
      "<div class=\"wide\"><table>\n<tr><th>object</th><th>id</th><th>size</th><th>views taught</th><th "
      "class=\"words\">shape symmetries</th><th>practice views</th><th>recall</th><th>precision</th><th "
      "class=\"words\">taken for</th></tr>\n";
  for (const StoredObject& object : store.objects) {
    page += fmt::format(
        "<tr><td><a href=\"#object-{0}\">{1}</a></td><td>{0}</td><td>{2}</td><td>{3}</td><td "
        "class=\"words\">{4}</td>{5}</tr>\n",
        object.id, escape_html(object.name), size_words(parts.sizes_m.at(object.id)), object.views,
        object.shape_symmetry ? escape_html(symmetry_words(*object.shape_symmetry)) : "unknown",
        practice_cells(object.practice));
  }
  return page + "</table></div>\n";
}

/// Returns the pairs of objects that can hardly be distinguished, by their calibration and by their meshes.
std::string lookalike_list(const store::ObjectStore& store, const StoreReportParts& parts) {
  std::string items;
  for (const std::string& line : confusion_lines(store)) items += fmt::format("<li>{}</li>\n", escape_html(line));
  for (const Lookalike& pair : parts.lookalikes) items += fmt::format("<li>{}</li>\n", escape_html(describe(pair)));
  return items.empty() ? "<p>No two objects that can hardly be told apart.</p>\n"
                       : "<h2>Hardly told apart</h2>\n<ul>\n" + items + "</ul>\n";
}

/// Returns a table of recall by ranges that begin where the one before ends.
std::string bin_table(const std::string& title, const std::vector<PracticeBin>& bins, double scale,
                      const std::string& unit) {
  std::string rows;
  double from = 0.0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const PracticeBin& bin = bins[i];
    const bool is_open = scale == 1.0 && i + 1 == bins.size();  // of distances the last bin ends nowhere
    const std::string range = is_open ? fmt::format("from {:g} {} on", from, unit)
                                      : fmt::format("{:g} to {:g} {}", scale * from, scale * bin.to, unit);
    rows +=
        fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", range, bin.shown, percent(bin.found, bin.shown));
    from = bin.to;
  }
  return fmt::format("<table>\n<tr><th>{}</th><th>views</th><th>found</th></tr>\n{}</table>\n", title, rows);
}

/// Draws one curve: precision from kLowest to 1 over recall from 0 to 1.
struct CurvePlot {
  static constexpr int kWidth = 300;
  static constexpr int kHeight = 180;
  static constexpr int kMargin = 34;
  static constexpr double kLowest = 0.5;

  static double x(double recall) { return kMargin + recall * (kWidth - kMargin - 8); }
  static double y(double precision) {
    const double shown = std::max(precision, kLowest);
    return 8 + (1.0 - shown) / (1.0 - kLowest) * (kHeight - kMargin - 8);
  }

  static std::string line(const PracticeCurve& curve, int shown, const char* style) {
    std::string points;
    for (const store::PracticeStep& step : curve) {
      const double recall = shown > 0 ? std::min(1.0, static_cast<double>(step.right) / shown) : 0.0;
      points += fmt::format("{:.1f},{:.1f} ", x(recall), y(store::estimate_precision(step.right, step.wrong)));
    }
    return fmt::format("<polyline class=\"{}\" points=\"{}\"/>", style, points);
  }

  static std::string axes() {
    std::string text;
    for (const double value : {0.5, 0.75, 1.0})
      text += fmt::format(
          "<line class=\"axis\" x1=\"{0:.1f}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text x=\"2\" "
          "y=\"{3:.1f}\">{4:g}</text>",
          x(0.0), x(1.0), y(value), y(value) + 4.0, value);
    for (const double value : {0.0, 0.5, 1.0})
      text += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:g}</text>", x(value),
                          kHeight - kMargin + 14, value);
    return text + fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">recall</text>", x(0.5), kHeight - 4);
  }
};

std::string curve_figure(const PracticeRecord& record) {
  return fmt::format(
      "<figure><svg width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"precision over "
      "recall\">{2}{3}{4}</svg><figcaption>precision over recall by <span class=\"score-key\">score</span> and by "
      "<span "
      "class=\"quality-key\">quality</span></figcaption></figure>\n",
      CurvePlot::kWidth, CurvePlot::kHeight, CurvePlot::axes(), CurvePlot::line(record.scores, record.shown, "score"),
      CurvePlot::line(record.qualities, record.shown, "quality"));
}

/// Returns thresholds and recall for some precisions that a user may ask for.
std::string threshold_table(const PracticeRecord& record) {
  std::string rows;
  for (const double precision : {0.9, 0.95, 0.98, 0.99}) {
    rows += fmt::format("<tr><td>{}</td>", precision);
    for (const PracticeCurve* curve : {&record.scores, &record.qualities}) {
      if (curve->empty()) {
        rows += "<td colspan=\"2\">nothing found</td>";
        continue;
      }
      const store::OperatingThreshold chosen = store::choose_threshold(*curve, record.shown, precision);
      rows += chosen.is_reached ? fmt::format("<td>{:.2f}</td><td>{:.0f} %</td>", chosen.from, 100.0 * chosen.recall)
                                : fmt::format("<td colspan=\"2\">not reached (best {:.3f})</td>", chosen.precision);
    }
    rows += "</tr>\n";
  }
  return "<table>\n<tr><th>--precision</th><th>score</th><th>recall</th><th>quality</th><th>recall</th></tr>\n" + rows +
         "</table>\n";
}

std::string object_section(const StoredObject& object, const StoreReportParts& parts) {
  std::string page = fmt::format("<section id=\"object-{}\">\n<h2>{}</h2>\n<p>{}; {}; taught from {}</p>\n", object.id,
                                 escape_html(object.name), size_words(parts.sizes_m.at(object.id)),
                                 object.coloured ? "coloured" : "colour unknown", escape_html(object.mesh));
  if (const auto image = parts.images.find(object.id); image != parts.images.end())
    page += fmt::format("<img alt=\"views of {}\" src=\"data:image/jpeg;base64,{}\">\n", escape_html(object.name),
                        base64(image->second));
  if (object.practice && object.practice->shown > 0) {
    const PracticeRecord& record = *object.practice;
    page += "<div class=\"parts\">\n" + bin_table("distance", record.by_distance, 1.0, "m") +
            bin_table("visible", record.by_visible, 100.0, "%") + threshold_table(record) + curve_figure(record) +
            "</div>\n";
  }
  return page + "</section>\n";
}

/// Reads an object's views, encoded smaller for a page; empty where they cannot be read.
std::string small_jpeg(const fs::path& file) {
  constexpr int kMaxWidth = 1100;
  constexpr int kQuality = 80;
  if (!fs::is_regular_file(file)) return {};
  cv::Mat image = read_colour_image(file);
  if (image.cols > kMaxWidth)
    cv::resize(image, image, {kMaxWidth, image.rows * kMaxWidth / image.cols}, 0, 0, cv::INTER_AREA);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality});
  return {bytes.begin(), bytes.end()};
}

/// Throws InputError for an existing file that is no report of ours.
void require_own_page(const fs::path& out) {
  if (!fs::exists(out)) return;
  require(fs::is_regular_file(out), "{}: is no file, expected a place for a page", out.string());
  require(read_file(out, "a page").find(kGenerator) != std::string::npos,
          "{}: is there and no page of hs-teach report, expected another --out", out.string());
}

}  // namespace

std::string store_page(const store::ObjectStore& store, const StoreReportParts& parts) {
  const std::string name = escape_html(store.folder.string());
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n{}\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{}</title>\n{}</head><body>\n<h1>{}</h1>\n<p>{} object{}. Recall and "
      "precision are those of poses that hs-pose would publish by default, in the rendered rooms in which scores and "
      "qualities were learnt; an object that is less than a tenth visible does not count.</p>\n",
      kGenerator, name, kStyle, name, store.objects.size(), store.objects.size() == 1 ? "" : "s");
  page += overview(store, parts) + lookalike_list(store, parts);
  for (const StoredObject& object : store.objects) page += object_section(object, parts);
  return page + "</body></html>\n";
}

void write_store_report(const fs::path& folder, const fs::path& out) {
  const store::ObjectStore store = store::read_store(folder);
  require_own_page(out);
  require_writable(out);
  StoreReportParts parts;
  parts.sizes_m = object_sizes(store);
  const std::map<std::string, Mesh> meshes = store::load_store_meshes(store);
  std::vector<NamedMesh> named;
  for (const StoredObject& object : store.objects) {
    named.emplace_back(object.name, &meshes.at(object.name));
    std::string image = small_jpeg(store.view_image(object.id));
    if (!image.empty()) parts.images[object.id] = std::move(image);
  }
  parts.lookalikes = find_lookalikes(named);
  write_file_atomically(out, store_page(store, parts));
}

}  // namespace houghstream::teach
