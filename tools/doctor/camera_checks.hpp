#pragma once

#include "tools/doctor/finding.hpp"
#include "tools/doctor/machine.hpp"

namespace houghstream::doctor {

/// Checks RGB-D cameras on USB and the right to use them; OpenNI2's library, its folder of drivers, their names,
/// whether they can be loaded, and whether there is one for each camera. Where no camera is plugged in and none is
/// `needed`, missing parts are notes: recordings can be replayed without.
Findings check_camera(const Machine& machine, bool needed);

}  // namespace houghstream::doctor
