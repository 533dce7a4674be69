#include "tools/doctor/machine.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <houghstream/status_t.hpp>
#include <memory>
#include <sstream>
#include <vector>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/bus/receive_buffer.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream::doctor {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Handles messages until `done` or the time is over.
template <typename Done>
void handle_until(LcmBus& bus, milliseconds time, const Done& done) {
  const Clock::time_point end = Clock::now() + time;
  while (!done() && Clock::now() < end) bus.handle(milliseconds(20));
}

/// Returns the last message of each camera that is heard on the channel within a second and a half.
template <typename Message, typename Known>
std::vector<Known> heard_of_cameras(const std::string& url, const std::string& channel,
                                    Known (*from_message)(const Message&)) {
  constexpr std::size_t kMaxCameras = 64;  // a sender of rubbish may make up names without end
  std::map<std::string, Known> cameras;
  try {
    LcmBus bus(url, "", Existing::kReplaced, AtStart::kFail);
    bus.subscribe(channel, [&](const ReceivedMessage& arrival) {
      Known known = from_message(decode_message<Message>(arrival.bytes));
      const std::string camera = known.frame.channel;
      if (cameras.size() < kMaxCameras || cameras.count(camera) > 0) cameras[camera] = std::move(known);
    });
    handle_until(bus, milliseconds(1500), [] { return false; });
  } catch (const std::exception&) {
    return {};  // the self test reports a fault of the bus
  }
  std::vector<Known> all;
  for (auto& [name, known] : cameras) all.push_back(std::move(known));
  return all;
}

}  // namespace

std::size_t heard_bytes(const std::string& url, const std::string& channel) {
  std::size_t largest = 0;
  try {
    LcmBus bus(url, "", Existing::kReplaced, AtStart::kFail);
    bus.subscribe(channel, [&](const ReceivedMessage& arrival) { largest = std::max(largest, arrival.bytes.size); });
    handle_until(bus, milliseconds(1000), [] { return false; });
  } catch (const std::exception&) {
    return 0;  // the self test reports a fault of the bus
  }
  return largest;
}

std::set<std::string> heard_frame_channels(const std::string& url) {
  constexpr std::size_t kMaxChannels = 64;  // a sender of rubbish may make up names without end
  std::set<std::string> channels;
  try {
    LcmBus bus(url, "", Existing::kReplaced, AtStart::kFail);
    bus.subscribe(".*", [&](const ReceivedMessage& arrival) {
      if (is_frame_message(arrival.bytes) && channels.size() < kMaxChannels) channels.insert(arrival.channel);
    });
    handle_until(bus, milliseconds(1500), [] { return false; });
  } catch (const std::exception&) {
    return {};  // the self test reports a fault of the bus
  }
  return channels;
}

std::map<std::string, std::string> heard_errors(const std::string& url) {
  constexpr std::size_t kMaxProcesses = 64;  // a sender of rubbish may make up names without end
  std::map<std::string, std::string> errors;
  try {
    LcmBus bus(url, "", Existing::kReplaced, AtStart::kFail);
    bus.subscribe(channel::kStatus, [&](const ReceivedMessage& arrival) {
      const auto status = decode_message<status_t>(arrival.bytes);
      const bool is_known = errors.count(status.process) > 0 || errors.size() < kMaxProcesses;
      if (!status.last_error.empty() && is_known) errors[status.process] = status.last_error;
    });
    handle_until(bus, milliseconds(1500), [] { return false; });
  } catch (const std::exception&) {
    return {};  // the self test reports a fault of the bus
  }
  return errors;
}

std::vector<CameraChroma> heard_camera_colours(const std::string& url) {
  return heard_of_cameras(url, channel::kCameraColours, camera_colours_from_message);
}

std::vector<CameraTiming> heard_camera_timings(const std::string& url) {
  return heard_of_cameras(url, channel::kCameraTiming, camera_timing_from_message);
}

SelfTest self_test(const std::string& url, std::size_t bytes) {
  constexpr int kMessages = 5;
  SelfTest result;
  try {
    LcmBus bus(url, "", Existing::kReplaced, AtStart::kFail);
    std::vector<std::uint8_t> message(bytes);
    bool came = false;
    // Another doctor may be at work on the same bus.
    const std::string channel = "HOUGHSTREAM_SELF_TEST_" + std::to_string(getpid());
    bus.subscribe(channel, [&](const ReceivedMessage& arrival) {
      came = came ||
             std::equal(message.begin(), message.end(), arrival.bytes.data, arrival.bytes.data + arrival.bytes.size);
    });
    for (; result.sent < kMessages; ++result.sent) {
      for (std::size_t i = 0; i < bytes; ++i) message[i] = static_cast<std::uint8_t>(i * 31 + i / 251 + result.sent);
      came = false;
      bus.publish(channel, {message.data(), message.size()}, 0);
      handle_until(bus, milliseconds(500), [&] { return came; });
      if (came) ++result.received;
    }
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  return result;
}

namespace {

namespace fs = std::filesystem;

std::string load_error(const fs::path& library) {
  void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) return dlerror();
  dlclose(handle);
  return "";
}

bool runs(const fs::path& program, const std::string& argument) {
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  std::string name = program.string();
  std::string word = argument;
  char* const arguments[] = {name.data(), word.data(), nullptr};
  pid_t pid = 0;
  const int failed = posix_spawn(&pid, name.c_str(), &quiet, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&quiet);
  int status = 0;
  return failed == 0 && waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Returns whether a firewall rule refuses other hosts, as far as this user may ask: nftables answers only root.
bool refuses_others(const std::string& port) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> answer(
      popen("nft list table inet houghstream 2>/dev/null", "r"), pclose);
  std::string text;
  char piece[512];
  while (answer && std::fgets(piece, sizeof piece, answer.get()) != nullptr) text += piece;
  return text.find("dport " + port) != std::string::npos && text.find("drop") != std::string::npos;
}

}  // namespace

std::string Machine::read(const std::string& path) const {
  std::ostringstream text;
  text << std::ifstream(root / path).rdbuf();  // a read error, as for files of /sys, does not throw
  return text.str();
}

std::optional<fs::path> Machine::find_program(const std::string& name) const {
  std::istringstream folders(environment("PATH"));
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (folder.empty() || folder.front() != '/') continue;
    const fs::path program = root / folder.substr(1) / name;
    std::error_code error;
    if (fs::is_regular_file(program, error)) return program;
  }
  return std::nullopt;
}

Machine this_machine() {
  Machine machine;
  machine.environment = [](const std::string& name) {
    const char* value = std::getenv(name.c_str());
    return std::string(value == nullptr ? "" : value);
  };
  machine.granted_receive_buffer = granted_receive_buffer;
  machine.heard_bytes = heard_bytes;
  machine.heard_frame_channels = heard_frame_channels;
  machine.heard_errors = heard_errors;
  machine.heard_camera_colours = heard_camera_colours;
  machine.heard_camera_timings = heard_camera_timings;
  machine.self_test = self_test;
  machine.may_use = [](const fs::path& file) { return access(file.c_str(), R_OK | W_OK) == 0; };
  machine.load_error = load_error;
  machine.refuses_others = refuses_others;
  machine.runs = runs;
  return machine;
}

}  // namespace houghstream::doctor
