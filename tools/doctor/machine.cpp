#include "tools/doctor/machine.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>

#include "pipeline/bus/receive_buffer.hpp"
#include "tools/doctor/lcm_probe.hpp"

namespace houghstream::doctor {
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

/// As far as this user may ask: nftables answers root only.
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
  text << std::ifstream(root / path).rdbuf();  // what fails while it is read, as files of /sys may, does not throw
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
  machine.self_test = self_test;
  machine.may_use = [](const fs::path& file) { return access(file.c_str(), R_OK | W_OK) == 0; };
  machine.load_error = load_error;
  machine.refuses_others = refuses_others;
  machine.runs = runs;
  return machine;
}

}  // namespace houghstream::doctor
