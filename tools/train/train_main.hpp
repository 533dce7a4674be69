#pragma once

#include <string>

namespace houghstream {

/// hs-train, and under another name hs-study-train, which is linked with detector/baseline.
int train_main(int argc, char** argv, const std::string& name);

}  // namespace houghstream
