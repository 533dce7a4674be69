#include "tools/stream/child.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "pipeline/base/checks.hpp"

namespace houghstream::stream {
namespace {

Ending describe(int status) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    return {false, true, fmt::format("was killed by signal {} ({})", number, strsignal(number))};
  }
  const int code = WEXITSTATUS(status);
  return {code == 0, false, fmt::format("ended with status {}", code)};
}

}  // namespace

Child::Child(const std::vector<std::string>& command) {
  const std::string& program = command.at(0);
  require(access(program.c_str(), X_OK) == 0, "{}: cannot be started: {}", program, std::strerror(errno));
  // Between fork and exec only what is safe in a process with threads: memory is asked for before.
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  require(pid_ >= 0, "{}: cannot be started: {}", program, std::strerror(errno));
  if (pid_ == 0) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(1);  // the parent died before it could be watched
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  setpgid(pid_, pid_);  // whichever of the two comes first
}

Child::~Child() {
  if (ending()) return;
  signal(SIGKILL);
  waitpid(pid_, nullptr, 0);
}

std::optional<Ending> Child::ending() {
  int status = 0;
  if (!ending_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    ending_ = describe(status);
    signal(SIGKILL);  // what it has started and left behind
  }
  return ending_;
}

void Child::signal(int number) const {
  kill(-pid_, number);
}

}  // namespace houghstream::stream
