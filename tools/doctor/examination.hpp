#pragma once

#include <filesystem>
#include <string>

#include "drivers/files/json_file.hpp"
#include "tools/doctor/finding.hpp"
#include "tools/doctor/machine.hpp"

namespace houghstream::doctor {

struct ExaminationSettings {
  std::string lcm_url;                         ///< "" = LCM's default
  std::string frame_channel = "OPENNI_FRAME";  ///< listened to for the size of the frames in use
  int width = 640;                             ///< pixels of a raw frame, where no frame is heard
  int height = 480;                            ///< pixels
  bool live = false;                           ///< a camera is needed
  std::filesystem::path types_jar;             ///< our types for lcm-spy
  std::filesystem::path programs;              ///< folder of our programs
};

/// Examines all parts that the stream needs. Changes nothing.
Findings examine(const Machine& machine, const ExaminationSettings& settings);

/// Returns a line for each finding, and below it the command that mends it; its level in a colour where a terminal
/// shows them.
std::string to_text(const Findings& findings, bool in_colours = false);

/// Returns {"works": , "findings": [{"level": "ok", "note" or "wrong", "name": , "found": , "remedy": }]}; the remedy
/// is null where there is no command.
OrderedJson to_json(const Findings& findings);

/// Returns the number of findings that keep the stream from working.
int count_wrong(const Findings& findings);

}  // namespace houghstream::doctor
