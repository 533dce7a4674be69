#include "tools/view/view_window.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <opencv2/highgui.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/messages/channels.hpp"
#include "tools/view/view_outputs.hpp"

namespace houghstream::view {
namespace {

const std::string kTitle = "Houghstream";
// Pixels. X11 ends a program whose window is to have more than 32767.
constexpr int kMaxSide = 16'384;

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

// Returns whether a window opens. It is tried in a process of its own: where a display is named but does not answer,
// the window library aborts the process instead of returning an error.
bool window_opens() {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    try {
      cv::namedWindow("display check");
    } catch (const cv::Exception&) {
      _exit(1);
    }
    _exit(0);
  }
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

KeyAction apply_key(int key, FrameViewSettings& settings) {
  constexpr int kEscape = 27;
  constexpr float kStep = 0.05F;
  switch (key) {
    case 'q':
    case kEscape: return KeyAction::kEnd;
    case ' ': settings.paused = !settings.paused; break;
    case 'c': return KeyAction::kNextCamera;
    case 't': return KeyAction::kTeach;
    case 'd': settings.show_depth = !settings.show_depth; break;
    case 'w': settings.show_world = !settings.show_world; break;
    case '3': settings.show_3d = !settings.show_3d; break;
    case '+':
    case '=':  // the plus key without shift
      settings.min_score = std::min(settings.min_score + kStep, 1.0F);
      break;
    case '-': settings.min_score = std::max(settings.min_score - kStep, 0.0F); break;
    default: return KeyAction::kNone;
  }
  return KeyAction::kRedraw;
}

void apply_mark(const cv::Rect& dragged, FrameViewSettings& settings) {
  constexpr int kClick_px = 4;
  const bool is_click = dragged.width < kClick_px && dragged.height < kClick_px;
  settings.box = is_click ? cv::Rect() : dragged;
  settings.at = is_click ? std::optional<cv::Point>(dragged.tl()) : std::nullopt;
}

ViewWindow::ViewWindow() {
  const std::string advice =
      "without one use --snapshot FILE.png, --video FILE.mp4, --pictures FOLDER, --preview or --http PORT";
  require(is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"), "no display for a window (DISPLAY is not set); {}", advice);
  require(window_opens(), "no display for a window (the one named by DISPLAY does not answer); {}", advice);
  cv::namedWindow(kTitle, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
  cv::setMouseCallback(kTitle, on_mouse, this);
}

void ViewWindow::on_mouse(int event, int x, int y, int /*flags*/, void* window) {
  auto& self = *static_cast<ViewWindow*>(window);
  const cv::Point place(cvRound(x / self.scale_), cvRound(y / self.scale_));
  if (event == cv::EVENT_LBUTTONDOWN) self.pressed_ = place;
  if (self.pressed_ && (event == cv::EVENT_MOUSEMOVE || event == cv::EVENT_LBUTTONUP))
    self.dragged_ = cv::Rect(*self.pressed_, place);
  if (event == cv::EVENT_LBUTTONUP) self.pressed_.reset();
}

void ViewWindow::show(const cv::Mat& image, const FrameId& id) {
  shown_ = image;
  id_ = id;
  scale_ = std::min(1.0, 1.0 * kMaxSide / std::max(image.cols, image.rows));
  if (scale_ >= 1.0) return cv::imshow(kTitle, image);
  cv::Mat smaller;
  cv::resize(image, smaller, {std::max(cvRound(scale_ * image.cols), 1), std::max(cvRound(scale_ * image.rows), 1)},
             0.0, 0.0, cv::INTER_AREA);
  cv::imshow(kTitle, smaller);
}

KeyAction ViewWindow::handle_keys(FrameViewSettings& settings) {
  constexpr int kMoment = 5;  // milliseconds
  const int key = cv::waitKey(kMoment);
  if (key == 's') save();
  KeyAction action = apply_key(key, settings);
  if (dragged_) {
    apply_mark(*dragged_, settings);
    dragged_.reset();
    if (action == KeyAction::kNone) action = KeyAction::kRedraw;
  }
  return cv::getWindowProperty(kTitle, cv::WND_PROP_VISIBLE) >= 1.0 ? action : KeyAction::kEnd;
}

void ViewWindow::save() const {
  if (shown_.empty()) return;
  const std::string file = fmt::format("view_{}_{}.png", channel::camera_name(id_.channel), id_.utime);
  try {
    save_image(file, shown_);
    log_info("saved {}", file);
  } catch (const InputError& error) {  // the stream can be viewed all the same
    log_error("{}", error.what());
  }
}

}  // namespace houghstream::view
