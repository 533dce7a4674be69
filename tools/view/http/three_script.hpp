#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace houghstream::view {

/// Files of Debian's package libjs-three, which draws the page's 3-D view of the world: three.js, version 111.
inline const std::vector<std::filesystem::path> kThreeScripts = {"/usr/share/javascript/three/three.min.js",
                                                                 "/usr/share/nodejs/three/build/three.min.js"};

/// Returns the first of these files that can be read, as text, or nothing where none can. It is read at each call: the
/// package may be installed while hs-view runs. Any thread may call.
std::optional<std::string> read_three_script(const std::vector<std::filesystem::path>& files = kThreeScripts);

}  // namespace houghstream::view
