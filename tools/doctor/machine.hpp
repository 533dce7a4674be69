#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/types/camera_timing.hpp"
#include "pipeline/types/chroma_map.hpp"

namespace houghstream::doctor {

/// Holds the result of a loopback test: messages sent on the bus and received by the sender.
struct SelfTest {
  int sent = 0;
  int received = 0;   ///< whole and unchanged
  std::string error;  ///< why the bus could not be used at all, else ""
};

/// Gives the doctor's view of a machine: files below `root`, and probes for the rest. Tests substitute others.
struct Machine {
  std::filesystem::path root = "/";
  /// Value of an environment variable, "" where it is not set.
  std::function<std::string(const std::string& name)> environment;
  /// Bytes of receive buffer that the kernel grants of those asked for.
  std::function<std::int64_t(std::int64_t asked)> granted_receive_buffer;
  /// Returns the size of the largest message received on the channel within a second; 0 = none.
  std::function<std::size_t(const std::string& url, const std::string& channel)> heard_bytes;
  /// Channels on which frames are heard within a second and a half.
  std::function<std::set<std::string>(const std::string& url)> heard_frame_channels;
  /// Returns the last errors of processes on the bus, by name, within a second and a half; those without one are left
  /// out.
  std::function<std::map<std::string, std::string>(const std::string& url)> heard_errors;
  /// Receives cameras' colours for a second and a half, and returns the last of each camera.
  std::function<std::vector<CameraChroma>(const std::string& url)> heard_camera_colours;
  /// Receives cameras' timings for a second and a half, and returns the last of each camera.
  std::function<std::vector<CameraTiming>(const std::string& url)> heard_camera_timings;
  /// Sends messages of so many bytes and waits for them.
  std::function<SelfTest(const std::string& url, std::size_t bytes)> self_test;
  /// Returns whether this user may read and write the file (a full path below root).
  std::function<bool(const std::filesystem::path&)> may_use;
  /// Why the shared library cannot be loaded, "" where it can.
  std::function<std::string(const std::filesystem::path&)> load_error;
  /// Returns whether this project's firewall is active: packets of other hosts to the port are dropped (nftables, table
  /// houghstream).
  std::function<bool(const std::string& port)> refuses_others;
  /// Returns whether the program runs when started with the argument.
  std::function<bool(const std::filesystem::path& program, const std::string& argument)> runs;

  /// Returns the file's text, "" where it cannot be read. `path` is from the root on, without a leading slash.
  std::string read(const std::string& path) const;
  /// Returns the path of a program on $PATH.
  std::optional<std::filesystem::path> find_program(const std::string& name) const;
};

/// This machine, as the calling process sees it.
Machine this_machine();

}  // namespace houghstream::doctor

// Probes of a Machine that use the bus itself. Neither throws.

namespace houghstream::doctor {

/// Implements Machine::heard_bytes for this machine.
std::size_t heard_bytes(const std::string& url, const std::string& channel);

/// Implements Machine::heard_frame_channels for this machine.
std::set<std::string> heard_frame_channels(const std::string& url);

/// Implements Machine::heard_errors for this machine.
std::map<std::string, std::string> heard_errors(const std::string& url);

/// Implements Machine::heard_camera_colours for this machine.
std::vector<CameraChroma> heard_camera_colours(const std::string& url);

/// Implements Machine::heard_camera_timings for this machine.
std::vector<CameraTiming> heard_camera_timings(const std::string& url);

/// Implements Machine::self_test for this machine: it sends some messages one after another on a channel of their own.
SelfTest self_test(const std::string& url, std::size_t bytes);

}  // namespace houghstream::doctor
