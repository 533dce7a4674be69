#include "tools/finder/stored_quality.hpp"

#include <utility>

#include "pipeline/base/check_settings.hpp"

namespace houghstream {
namespace {

template <typename Settings>
nlohmann::json numbers_to_json(const Settings& settings) {
  nlohmann::json out = nlohmann::json::object();
  for_each_number(settings, [&](const auto& field, double value) { out[field.name] = value; });
  return out;
}

QualityTerms terms_from(const nlohmann::json& entry, const std::string& name, const std::string& where) {
  require(entry.contains(name) && entry[name].is_object(), "{}: '{}' of the quality expected, with {} terms", where,
          name, kQualityTerms.size());
  QualityTerms terms;
  for_each_number(terms, [&](const auto& field, double& value) {
    require(entry[name].contains(field.name),
            "{}: '{}' of the quality has no '{}': it was learnt from other terms; hs-teach practise recalibrates it",
            where, name, field.name);
    value = json_number(entry[name], field.name, where);
  });
  require(entry[name].size() == kQualityTerms.size(),
          "{}: '{}' of the quality has {} terms, expected {}; hs-teach practise recalibrates it", where, name,
          entry[name].size(), kQualityTerms.size());
  return terms;
}

/// A store that was written before this was learnt has the value of `otherwise`.
PresenceSettings presence_from(const nlohmann::json& entry, const PresenceSettings& otherwise,
                               const std::string& where) {
  if (!entry.contains("presence")) return otherwise;
  const nlohmann::json& stored = entry["presence"];
  require(stored.is_object() && stored.size() == 3,
          "{}: 'presence' of the quality expected, with bias, of_score and of_quality", where);
  PresenceSettings presence;
  for_each_number(presence, [&](const auto& field, double& value) { value = json_number(stored, field.name, where); });
  return presence;
}

/// A store that was written before this was learnt has the value of `otherwise`.
TextureSettings texture_settings_from(const nlohmann::json& entry, const TextureSettings& otherwise,
                                      const std::string& where) {
  if (!entry.contains("print")) return otherwise;
  const nlohmann::json& stored = entry["print"];
  require(stored.is_object() && stored.size() == 2, "{}: 'print' of the quality expected, with bias and of_margin",
          where);
  TextureSettings texture;
  for_each_number(texture, [&](const auto& field, double& value) { value = json_number(stored, field.name, where); });
  return texture;
}

}  // namespace

nlohmann::json quality_to_json(const QualitySettings& settings) {
  return {{"bias", settings.bias},
          {"weights", numbers_to_json(settings.weights)},
          {"typical", numbers_to_json(settings.mean_of_correct)},
          {"presence", numbers_to_json(settings.presence)},
          {"print", numbers_to_json(settings.texture)}};
}

std::map<std::string, QualitySettings> stored_quality(const store::ObjectStore& objects,
                                                      const QualitySettings& others) {
  std::map<std::string, QualitySettings> learnt;
  for (const auto& [name, entry] : objects.quality()) {
    const std::string where = fmt::format("{} object '{}'", (objects.folder / "store.json").string(), name);
    QualitySettings settings = others;
    settings.bias = json_number(entry, "bias", where);
    settings.weights = terms_from(entry, "weights", where);
    settings.mean_of_correct = terms_from(entry, "typical", where);
    settings.presence = presence_from(entry, others.presence, where);
    settings.texture = texture_settings_from(entry, others.texture, where);
    check_settings(settings, where + ": quality");
    learnt[name] = settings;
  }
  return learnt;
}

PoseSettings pose_settings_of(PoseSettings common, const std::optional<store::ObjectStore>& objects,
                              std::optional<float> min_quality) {
  PoseSettings settings = std::move(common);
  if (objects) {
    settings.quality.min_quality = kStoreQuality;
    settings.quality.min_candidate_quality = kStoreCandidateQuality;
    settings.class_quality = stored_quality(*objects, settings.quality);
    settings.model.vote_centres = objects->vote_centres();
    settings.model.symmetries = objects->symmetries_by_name();
    settings.model.shape_symmetries = objects->shape_symmetries();
    settings.region.tone = objects->tone;
  }
  if (min_quality) set_min_quality(*min_quality, settings);
  return settings;
}

}  // namespace houghstream
