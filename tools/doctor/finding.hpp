#pragma once

#include <string>
#include <vector>

namespace houghstream::doctor {

/// Holds the result of one check.
struct Finding {
  enum class Level {
    kOk,
    kNote,   ///< something is missing that the stream can do without
    kWrong,  ///< the stream would not work
  };
  Level level = Level::kOk;
  std::string name;    ///< subject of the check, for instance "multicast route"
  std::string what;    ///< result of the check, one line
  std::string remedy;  ///< the command that mends it; "" where there is nothing to mend or no command can
};

using Findings = std::vector<Finding>;

inline Finding ok(std::string name, std::string what) {
  return {Finding::Level::kOk, std::move(name), std::move(what), ""};
}

inline Finding note(std::string name, std::string what, std::string remedy = "") {
  return {Finding::Level::kNote, std::move(name), std::move(what), std::move(remedy)};
}

inline Finding wrong(std::string name, std::string what, std::string remedy = "") {
  return {Finding::Level::kWrong, std::move(name), std::move(what), std::move(remedy)};
}

}  // namespace houghstream::doctor
