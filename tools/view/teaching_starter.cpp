#include "tools/view/teaching_starter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"

namespace houghstream::view {

std::vector<std::string> teaching_command(const TeachingOrder& order) {
  std::vector<std::string> words = {(order.executables / "hs-teach").string(),
                                    "show",
                                    "--from-stream",
                                    "--name",
                                    order.name,
                                    "--out",
                                    order.store,
                                    "--channel",
                                    order.channel};
  if (order.joins_others) words.emplace_back("--add");
  if (!order.lcm_url.empty()) words.insert(words.end(), {"--lcm-url", order.lcm_url});
  if (order.box) {
    words.insert(words.end(), {"--box", fmt::format("{},{},{},{}", order.box->x, order.box->y, order.box->width,
                                                    order.box->height)});
  } else if (order.at) {
    words.insert(words.end(), {"--at", fmt::format("{},{}", order.at->x, order.at->y)});
  }
  return words;
}

std::string free_name(const std::vector<std::string>& known) {
  for (int i = 1;; ++i) {
    std::string name = fmt::format("object_{}", i);
    if (std::find(known.begin(), known.end(), name) == known.end()) return name;
  }
}

void TeachingStarter::press(const TeachingOrder& order) {
  if (runs()) {
    // Asked twice, it would end at once: what was shown is being taught.
    if (!is_asked_to_end_) child_->signal(SIGINT);
    is_asked_to_end_ = true;
    return;
  }
  try {
    is_asked_to_end_ = false;
    child_ = std::make_unique<stream::ChildProcess>(teaching_command(order));
    log_info("{} is taught: move the camera around it; the same key ends the take", order.name);
  } catch (const InputError& error) {
    log_error("{}", error.what());
  }
}

bool TeachingStarter::runs() {
  if (!child_) return false;
  const std::optional<stream::ExitStatus> ending = child_->poll_exit();
  if (!ending) return true;
  if (!ending->success) log_warning("hs-teach {}", ending->words);
  child_.reset();
  return false;
}

}  // namespace houghstream::view
