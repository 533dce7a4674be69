#pragma once

#include "tools/common/command_line.hpp"

// The studies that hs-study holds. Each adds its options to `app`, which has its name and its words for --help by then,
// and returns the exit status; argv[0] is the study's name.

namespace houghstream::studies {

int colours_command(CommandLine& app, int argc, char** argv);
int evaluate_command(CommandLine& app, int argc, char** argv);
int failures_command(CommandLine& app, int argc, char** argv);
int hough_command(CommandLine& app, int argc, char** argv);
int household_command(CommandLine& app, int argc, char** argv);
int kernels_command(CommandLine& app, int argc, char** argv);
int linemod_command(CommandLine& app, int argc, char** argv);
int pose_command(CommandLine& app, int argc, char** argv);
int quality_command(CommandLine& app, int argc, char** argv);
int recorded_command(CommandLine& app, int argc, char** argv);
int shown_command(CommandLine& app, int argc, char** argv);
int speed_command(CommandLine& app, int argc, char** argv);
int terms_command(CommandLine& app, int argc, char** argv);
int tracks_command(CommandLine& app, int argc, char** argv);
int train_command(CommandLine& app, int argc, char** argv);

}  // namespace houghstream::studies
