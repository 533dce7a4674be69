#pragma once

#include <string>

namespace houghstream {

/// hs-evaluate, and under another name hs-study-evaluate, which is linked with detector/baseline.
int evaluate_main(int argc, char** argv, const std::string& name);

}  // namespace houghstream
