#pragma once

namespace houghstream {

// Each settings struct has one list of its fields, a template fields(settings, visit) that hands each of them to
// `visit`: a number with its range, or settings within settings. A number's name, range and unit are stated nowhere
// else: the check (check_settings.hpp), the files and the command line read this list.

/// Range of a number, with both ends.
struct NumberRange {
  double min = 0.0;
  double max = 0.0;
};

/// Describes a number of a settings struct. Messages and files call it by its name; both ends of its range are allowed,
/// and an infinite maximum means no limit.
template <typename Settings, typename Value>
struct NumberField {
  const char* name = "";
  Value Settings::*member = nullptr;
  double min = 0.0;
  double max = 0.0;
  const char* unit = "";  ///< empty for shares, probabilities and counts
};

template <typename Settings, typename Value>
constexpr NumberField<Settings, Value> number(const char* name, Value Settings::*member, double min, double max,
                                              const char* unit = "") {
  NumberField<Settings, Value> field;
  field.name = name;
  field.member = member;
  field.min = min;
  field.max = max;
  field.unit = unit;
  return field;
}

/// Settings within settings, which have a list of their own.
template <typename Settings, typename Value>
struct GroupField {
  const char* name = "";
  Value Settings::*member = nullptr;
};

template <typename Settings, typename Value>
constexpr GroupField<Settings, Value> group(const char* name, Value Settings::*member) {
  return {name, member};
}

}  // namespace houghstream
