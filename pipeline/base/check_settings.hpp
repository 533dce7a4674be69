#pragma once

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

/// Returns the description of a member that is in its settings' list of fields.
template <typename Settings, typename Value>
NumberRange range_of(Value Settings::*member) {
  NumberRange range;
  bool is_listed = false;
  fields(Settings{}, [&](const auto& field) {
    if constexpr (std::is_same_v<std::decay_t<decltype(field)>, NumberField<Settings, Value>>) {
      if (field.member != member) return;
      range.min = field.min;
      range.max = field.max;
      is_listed = true;
    }
  });
  if (!is_listed) throw std::logic_error("a number that its settings do not list");
  return range;
}

template <typename Settings, typename Value>
void check_number(const NumberField<Settings, Value>& field, Value value, const std::string& source) {
  const bool has_max = std::isfinite(field.max);
  const bool fits =  // a comparison with NaN is never true
      value >= static_cast<Value>(field.min) && (!has_max || value <= static_cast<Value>(field.max));
  if (fits) return;
  const std::string max = has_max ? fmt::format("to {}", field.max) : "or more";
  fail("{}: {} {}, expected {} {}{}{}", source, field.name, value, field.min, max, *field.unit == '\0' ? "" : " ",
       field.unit);
}

template <typename Settings>
void check_settings(const Settings& settings, const std::string& source);

/// Checks the fields of a list alone, for a check_settings() that adds checks of its own.
template <typename Settings>
void check_fields(const Settings& settings, const std::string& source) {
  fields(settings, [&](const auto& field) {
    const auto& value = settings.*field.member;
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      check_number(field, value, source);
    } else {
      check_settings(value, fmt::format("{}: {}", source, field.name));
    }
  });
}

/// Throws InputError with one line that names `source`, the field, its value and its range, where a number is out of
/// it. Settings whose fields depend on each other have an overload beside them.
template <typename Settings>
void check_settings(const Settings& settings, const std::string& source) {
  check_fields(settings, source);
}

/// Calls `visit` with the field and the value of each number, of settings within settings too, in the lists' order.
template <typename Settings, typename Visit>
void for_each_number(Settings& settings, const Visit& visit) {
  fields(settings, [&](const auto& field) {
    auto& value = settings.*field.member;
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      visit(field, value);
    } else {
      for_each_number(value, visit);
    }
  });
}

}  // namespace houghstream
