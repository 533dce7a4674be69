#include "tools/stream/child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>

#include "pipeline/base/checks.hpp"

namespace houghstream::stream {
namespace {

std::optional<std::chrono::microseconds> extension_in(std::string_view words) {
  constexpr std::string_view kKey = "EXTEND_TIMEOUT_USEC=";
  const std::size_t at = words.find(kKey);
  if (at == std::string_view::npos || (at > 0 && words[at - 1] != '\n')) return std::nullopt;
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(words.data() + at + kKey.size(), words.data() + words.size(), value);
  constexpr std::int64_t kMaxUs = 60'000'000;  // maximum of one notice
  if (fault != std::errc() || value < 0 || value > kMaxUs) return std::nullopt;
  return std::chrono::microseconds(value);
}

ExitStatus describe(int status) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    return {false, true, fmt::format("was killed by signal {} ({})", number, strsignal(number))};
  }
  const int code = WEXITSTATUS(status);
  return {code == 0, false, fmt::format("ended with status {}", code)};
}

/// This process' environment, but for the service manager of the process that it is for.
std::vector<std::string> environment_for(const std::string& notify_socket) {
  const std::string key = "NOTIFY_SOCKET=";
  std::vector<std::string> words;
  for (char** word = environ; *word != nullptr; ++word)
    if (std::strncmp(*word, key.c_str(), key.size()) != 0) words.emplace_back(*word);
  if (!notify_socket.empty()) words.push_back(key + notify_socket);
  return words;
}

/// Returns the pointers that exec takes; they point into `words`.
std::vector<char*> pointers_to(const std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

NoticeSocket::NoticeSocket() : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (socket_ < 0) return;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  // The socket is bound to the family alone, so that it gets an unused name of the abstract namespace.
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address.sun_family)) != 0) return;
  socklen_t length = sizeof(address);
  if (getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length) != 0) return;
  const std::size_t size = length - offsetof(sockaddr_un, sun_path);
  if (size > 1) name_ = "@" + std::string(address.sun_path + 1, size - 1);
}

NoticeSocket::~NoticeSocket() {
  if (socket_ >= 0) close(socket_);
}

std::optional<std::chrono::microseconds> NoticeSocket::extension() {
  std::array<char, 4096> words{};
  std::optional<std::chrono::microseconds> extension;
  constexpr int kMaxNotices = 64;  // a limit, as a process may send without end
  ssize_t size = 0;
  for (int i = 0; i < kMaxNotices && socket_ >= 0 && (size = recv(socket_, words.data(), words.size(), 0)) >= 0; ++i) {
    if (const auto asked = extension_in({words.data(), static_cast<std::size_t>(size)})) extension = asked;
  }
  return extension;
}

ChildProcess::ChildProcess(const std::vector<std::string>& command, bool capture_stderr) {
  const std::string& program = command.at(0);
  require(access(program.c_str(), X_OK) == 0, "{}: cannot be started: {}", program, std::strerror(errno));
  // Between fork and exec only functions that are safe in a process with threads may be called, so all memory is
  // allocated before.
  const std::vector<std::string> environment = environment_for(notices_.name());
  const std::vector<char*> arguments = pointers_to(command);
  const std::vector<char*> variables = pointers_to(environment);
  // Neither end waits: where this process is stopped, lines are lost and the child continues.
  std::array<int, 2> pipe = {-1, -1};
  require(!capture_stderr || pipe2(pipe.data(), O_CLOEXEC | O_NONBLOCK) == 0, "{}: cannot be heard: {}", program,
          std::strerror(errno));
  const pid_t parent = getpid();
  pid_ = fork();
  const int error = errno;
  if (pid_ != 0 && capture_stderr) close(pipe[1]);
  words_ = pipe[0];
  require(pid_ >= 0, "{}: cannot be started: {}", program, std::strerror(error));
  if (pid_ == 0) {
    setpgid(0, 0);
    if (capture_stderr) dup2(pipe[1], STDERR_FILENO);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(1);  // the parent died before it could be watched
    execve(arguments[0], arguments.data(), variables.data());
    _exit(127);
  }
  setpgid(pid_, pid_);  // whichever of the two comes first
}

ChildProcess::~ChildProcess() {
  if (!poll_exit()) {
    signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
    pass_on_words();
  }
  if (words_ >= 0) close(words_);
}

void ChildProcess::pass_on_words() {
  constexpr std::size_t kMaxLineLength = 1000;
  std::array<char, 4096> piece{};
  constexpr int kMaxPieces = 32;  // more than a pipe holds; a limit, as a process may write without end
  ssize_t size = 0;
  for (int i = 0; i < kMaxPieces && words_ >= 0 && (size = read(words_, piece.data(), piece.size())) > 0; ++i) {
    std::fwrite(piece.data(), 1, static_cast<std::size_t>(size), stderr);
    for (ssize_t at = 0; at < size; ++at) {
      const char c = piece[static_cast<std::size_t>(at)];
      if (c != '\n' && line_.size() < kMaxLineLength) line_ += c;
      if (c != '\n') continue;
      if (!line_.empty()) last_stderr_line_ = std::exchange(line_, "");
    }
  }
  std::fflush(stderr);
}

std::optional<ExitStatus> ChildProcess::poll_exit() {
  int status = 0;
  pass_on_words();
  if (!exit_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    pass_on_words();
    exit_ = describe(status);
    signal(SIGKILL);  // ends the processes that it left behind
  }
  return exit_;
}

bool ChildProcess::needs_time() {
  const auto now = std::chrono::steady_clock::now();
  if (const auto extension = notices_.extension()) needs_time_until_ = now + *extension;
  return now < needs_time_until_;
}

void ChildProcess::signal(int number) const {
  kill(-pid_, number);
}

}  // namespace houghstream::stream
