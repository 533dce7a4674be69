#include "tools/common/stored_quality.hpp"

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

nlohmann::json to_json(const QualityTerms& terms) {
  nlohmann::json out = nlohmann::json::object();
  for (std::size_t i = 0; i < kQualityTerms.size(); ++i) out[kQualityTermNames[i]] = terms.*kQualityTerms[i];
  return out;
}

QualityTerms terms_from(const nlohmann::json& entry, const std::string& name, const std::string& where) {
  require(entry.contains(name) && entry[name].is_object(), "{}: '{}' of the quality expected, with {} terms", where,
          name, kQualityTerms.size());
  QualityTerms terms;
  for (std::size_t i = 0; i < kQualityTerms.size(); ++i) {
    require(entry[name].contains(kQualityTermNames[i]),
            "{}: '{}' of the quality has no '{}': it was learnt from other terms; hs-teach practise learns it anew",
            where, name, kQualityTermNames[i]);
    terms.*kQualityTerms[i] = json_number(entry[name], kQualityTermNames[i], where);
  }
  require(entry[name].size() == kQualityTerms.size(),
          "{}: '{}' of the quality has {} terms, expected {}; hs-teach practise learns it anew", where, name,
          entry[name].size(), kQualityTerms.size());
  return terms;
}

/// Of a store that was written before it was learnt: what `otherwise` says.
PresenceSettings presence_from(const nlohmann::json& entry, const PresenceSettings& otherwise,
                               const std::string& where) {
  if (!entry.contains("presence")) return otherwise;
  const nlohmann::json& presence = entry["presence"];
  require(presence.is_object() && presence.size() == 3,
          "{}: 'presence' of the quality expected, with bias, of_score and of_quality", where);
  return {json_number(presence, "bias", where), json_number(presence, "of_score", where),
          json_number(presence, "of_quality", where)};
}

/// Of a store that was written before it was learnt: what `otherwise` says.
PrintSettings print_from(const nlohmann::json& entry, const PrintSettings& otherwise, const std::string& where) {
  if (!entry.contains("print")) return otherwise;
  const nlohmann::json& print = entry["print"];
  require(print.is_object() && print.size() == 2, "{}: 'print' of the quality expected, with bias and of_margin",
          where);
  return {json_number(print, "bias", where), json_number(print, "of_margin", where)};
}

}  // namespace

nlohmann::json quality_to_json(const QualitySettings& settings) {
  const PresenceSettings& presence = settings.presence;
  return {{"bias", settings.bias},
          {"weights", to_json(settings.weights)},
          {"typical", to_json(settings.typical)},
          {"presence",
           {{"bias", presence.bias}, {"of_score", presence.score_weight}, {"of_quality", presence.quality_weight}}},
          {"print", {{"bias", settings.print.bias}, {"of_margin", settings.print.margin_weight}}}};
}

std::map<std::string, QualitySettings> stored_quality(const store::ObjectStore& objects,
                                                      const QualitySettings& others) {
  std::map<std::string, QualitySettings> learnt;
  for (const auto& [name, entry] : objects.quality()) {
    const std::string where = fmt::format("{} object '{}'", (objects.folder / "store.json").string(), name);
    QualitySettings settings = others;
    settings.bias = json_number(entry, "bias", where);
    settings.weights = terms_from(entry, "weights", where);
    settings.typical = terms_from(entry, "typical", where);
    settings.presence = presence_from(entry, others.presence, where);
    settings.print = print_from(entry, others.print, where);
    learnt[name] = settings;
  }
  return learnt;
}

void apply_store_settings(const store::ObjectStore& objects, std::optional<float> min_quality, PoseSettings& settings) {
  settings.quality.least = min_quality.value_or(kStoreQuality);
  settings.quality.min_candidate_quality = min_quality.value_or(kStoreCandidateQuality);
  settings.class_quality = stored_quality(objects, settings.quality);
  settings.model.vote_centres = objects.vote_centres();
  settings.model.symmetries = objects.symmetries_by_name();
  settings.model.shape_symmetries = objects.shape_symmetries();
  settings.region.tone = objects.tone;
}

}  // namespace houghstream
