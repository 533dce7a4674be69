#include "tools/stream/stream_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream::stream {
namespace {

/// Returns whether a backslash escapes. Within '...' it never does; within "..." only before the characters that need
/// it there.
bool escapes(const std::string& text, std::size_t at, char quote) {
  if (text[at] != '\\' || quote == '\'') return false;
  return quote == '\0' || text.compare(at + 1, 1, "\"") == 0 || text.compare(at + 1, 1, "\\") == 0;
}

using Words = std::vector<std::string>;

/// Returns hs-NAME with the arguments common to all, and with the further words.
ChildPlan plan(const StreamOptions& options, const std::string& name, const Words& words, const std::string& further) {
  ChildPlan plan;
  plan.name = name;
  plan.command = {(options.executables / ("hs-" + name)).string(), "--channel", options.channel};
  if (!options.lcm_url.empty()) plan.command.insert(plan.command.end(), {"--lcm-url", options.lcm_url});
  plan.command.insert(plan.command.end(), words.begin(), words.end());
  const Words more = shell_words(further, "--" + name + "-options");
  plan.command.insert(plan.command.end(), more.begin(), more.end());
  return plan;
}

/// A source of frames, and the channel that it sends them on.
struct NamedSource {
  std::string channel;
  std::string source;
};

/// Returns CHANNEL of CHANNEL=SOURCE; "" where there is none, since the name of a file may hold a '=' too.
std::string channel_of(const std::string& words) {
  const std::string name = words.substr(0, words.find('='));
  const auto is_of_name = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return name.size() < words.size() && std::all_of(name.begin(), name.end(), is_of_name) ? name : "";
}

std::vector<NamedSource> sources_of(const StreamOptions& options) {
  if (options.source.empty()) return {};
  if (channel_of(options.source).empty()) return {{options.channel, options.source}};
  std::vector<NamedSource> sources;
  for (const std::string& word : shell_words(options.source, "--source")) {
    const std::string channel = channel_of(word);
    require(!channel.empty(), "--source: '{}', expected CHANNEL=SOURCE, as for the first camera", word);
    const bool is_taken =
        std::any_of(sources.begin(), sources.end(), [&](const NamedSource& other) { return other.channel == channel; });
    require(!is_taken, "--source: two cameras for channel {}, expected one", channel);
    sources.push_back({channel, word.substr(channel.size() + 1)});
  }
  return sources;
}

/// Returns all of its channels as a regular expression.
std::string pattern_of(const std::vector<NamedSource>& sources) {
  std::string pattern;
  for (const NamedSource& each : sources) pattern += (pattern.empty() ? "" : "|") + each.channel;
  return pattern;
}

void add_number(const std::string& option, const std::optional<double>& value, Words& words) {
  if (value) words.insert(words.end(), {option, fmt::format("{}", *value)});
}

std::vector<ChildPlan> plan_captures(const StreamOptions& options, const std::vector<NamedSource>& sources) {
  std::vector<ChildPlan> plans;
  for (const NamedSource& each : sources) {
    StreamOptions camera_options = options;
    camera_options.channel = each.channel;
    plans.push_back(plan(camera_options, "capture", {"--source", each.source}, options.capture_options));
    if (sources.size() > 1) plans.back().name += " " + each.channel;
    plans.back().ends_stream = true;
    plans.back().is_started_last = true;
  }
  return plans;
}

}  // namespace

std::vector<std::string> shell_words(const std::string& text, const std::string& source) {
  std::vector<std::string> words;
  std::string word;
  bool has_begun = false;  // the word, which may be ""
  char quote = '\0';       // open quotation mark
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_blank = c == ' ' || c == '\t' || c == '\n';
    if (quote == '\0' && is_blank) {
      if (has_begun) words.push_back(std::exchange(word, ""));
      has_begun = false;
      continue;
    }
    has_begun = true;
    if (quote != '\0' ? c == quote : c == '\'' || c == '"') {
      quote = quote == '\0' ? c : '\0';
    } else if (escapes(text, i, quote)) {
      ++i;
      require(i < text.size(), "{} '{}': nothing follows its last backslash", source, printable(text));
      word += text[i];
    } else {
      word += c;
    }
  }
  require(quote == '\0', "{} '{}': a quote has no end, expected another {}", source, printable(text), quote);
  if (has_begun) words.push_back(word);
  return words;
}

std::vector<ChildPlan> plan_stream(const StreamOptions& given) {
  StreamOptions options = given;
  const std::vector<NamedSource> sources = sources_of(given);
  if (!sources.empty()) options.channel = pattern_of(sources);
  const Words camera = options.camera.empty() ? Words() : Words{"--camera", options.camera};
  const bool has_store = !options.objects.empty();
  const Words store = {"--objects", options.objects};
  const Words forest = {"--forest", options.forest};
  const Words models = options.models.empty() ? Words() : Words{"--models", options.models};
  const auto with_camera = [&](Words words) {
    words.insert(words.end(), camera.begin(), camera.end());
    return words;
  };
  const bool own_looks = options.detect_options.find("--looks-per-second") != std::string::npos;
  const std::string looks = options.follow && !own_looks ? "--looks-per-second 5 " : "";
  const std::string follow = options.follow ? "--follow " : "";
  Words detected = with_camera(has_store ? store : forest);
  Words posed = with_camera(has_store ? store : models);
  Words tracked = posed;
  const Words viewed = posed;
  add_number("--threshold", options.threshold, detected);
  add_number("--min-quality", options.min_quality, posed);
  for (Words* words : {&detected, &posed}) add_number("--precision", options.precision, *words);
  if (!options.cameras.empty()) tracked.insert(tracked.end(), {"--cameras", options.cameras});
  std::vector<ChildPlan> plans;
  plans.push_back(plan(options, "detect", detected, looks + options.detect_options));
  if (has_store || !models.empty()) plans.push_back(plan(options, "pose", posed, follow + options.pose_options));
  if (options.track || !options.cameras.empty())
    plans.push_back(plan(options, "track", tracked, options.track_options));
  if (options.view) {
    plans.push_back(plan(options, "view", viewed, options.view_options));
    plans.back().ends_stream = true;
  }
  for (ChildPlan& capture : plan_captures(options, sources)) plans.push_back(std::move(capture));
  return plans;
}

}  // namespace houghstream::stream
