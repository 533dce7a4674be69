#include "tools/common/progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "pipeline/base/printable.hpp"

namespace houghstream {
namespace {

constexpr double kSilent_s = 2.0;
constexpr double kOften_s = 0.5;    // interval on a terminal
constexpr double kSeldom_s = 10.0;  // interval elsewhere

std::string in_words(double seconds) {
  const long long whole = std::llround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace

std::string progress_words(const std::string& title, double done, double whole, double seconds) {
  if (whole <= 0.0) return fmt::format("{}: {:.0f} so far", title, done);
  if (done <= 0.0) return fmt::format("{}: 0 %", title);
  const double fraction = std::min(done / whole, 1.0);
  return fmt::format("{}: {:.0f} %, about {} left", title, std::floor(100.0 * fraction),
                     in_words(seconds * (1.0 - fraction) / fraction));
}

ProgressOutput progress_on_stderr() {
  ProgressOutput output;
  output.seconds = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  output.write = [](const std::string& text) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
  };
  output.is_terminal = isatty(STDERR_FILENO) == 1;
  return output;
}

ProgressLine::ProgressLine(const std::string& title, double whole, ProgressOutput output)
    : title_(printable(title)), whole_(whole), output_(std::move(output)), begin_(output_.seconds()), due_(kSilent_s) {}

ProgressLine::~ProgressLine() {
  if (length_ > 0) output_.write(std::string(length_, ' ') + "\r");
}

void ProgressLine::at(double done) {
  const std::lock_guard<std::mutex> lock(mutex_);
  done_ = done;
  say(done_);
}

void ProgressLine::add(double more) {
  const std::lock_guard<std::mutex> lock(mutex_);
  done_ += more;
  say(done_);
}

void ProgressLine::say(double done) {
  const double now = output_.seconds() - begin_;
  if (now < due_) return;
  due_ = now + (output_.is_terminal ? kOften_s : kSeldom_s);
  const std::string words = progress_words(title_, done, whole_, now);
  if (!output_.is_terminal) return output_.write(words + "\n");
  // The line is as long as the one that it overwrites; further output begins where it does.
  length_ = std::max(words.size(), length_);
  output_.write(words + std::string(length_ - words.size(), ' ') + "\r");
}

}  // namespace houghstream
