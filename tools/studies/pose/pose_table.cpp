#include "tools/studies/pose/pose_table.hpp"

#include <fmt/format.h>

#include <cmath>

namespace houghstream {
namespace {

std::string known(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : std::string();
}

const char* to_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kTrue: return "true";
    case Verdict::kFalse: return "false";
    case Verdict::kIgnored: return "ignored";
  }
  return "invalid";
}

}  // namespace

std::string pose_table_header() {
  return "variant,scene,frame,object,visible,verdict,score,status,quality,add,add_s,mm,deg,ms,strict\n";
}

std::string pose_table_rows(const std::string& variant, const std::vector<PoseTrial>& trials) {
  std::string text;
  for (const PoseTrial& trial : trials) {
    text += fmt::format("{},{},{},{},{},{},{:.4f},{},{:.4f},{},{},{},{},{},{}\n", variant, trial.scene, trial.image,
                        trial.class_name, known(trial.visible_fraction, 3), to_word(trial.verdict), trial.score,
                        to_string(trial.status), trial.quality, known(trial.add, 4), known(trial.add_s, 4),
                        known(1e3 * trial.shift_m, 2), known(trial.turn_deg, 2), known(trial.ms, 3),
                        known(trial.strict, 4));
  }
  return text;
}

}  // namespace houghstream
