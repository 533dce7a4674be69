#pragma once

#include <memory>
#include <optional>
#include <string>

#include "drivers/store/store_watcher.hpp"
#include "tools/view/bus_watcher.hpp"
#include "tools/view/drawing/frame_view.hpp"
#include "tools/view/http/live_page.hpp"
#include "tools/view/teaching_starter.hpp"
#include "tools/view/view_outputs.hpp"
#include "tools/view/view_window.hpp"

namespace houghstream::view {

/// Settings of the drawing of each frame, and of its outputs.
struct FrameRendererSettings {
  std::optional<Camera> camera;  ///< camera of frames that carry none of their own
  std::string models;            ///< folder of models for outlines; "" = none
  double model_unit_m = 1e-3;    ///< unit of the models' coordinates
  std::string objects;           ///< object store with the models, instead; followed while it changes; "" = none
  FrameViewSettings image;
  bool preview = false;                 ///< send each image on the preview channel
  std::string http;                     ///< address of a page for browsers, [ADDRESS:]PORT; "" = no page
  std::vector<std::string> http_hosts;  ///< names, beside its own, that the page answers to
  std::string foxglove;                 ///< address that Foxglove connects to, [ADDRESS:]PORT; "" = none
  OutputSettings outputs;

  /// Files or the preview are asked for.
  bool writes() const {
    return preview || !outputs.snapshot.empty() || !outputs.video.empty() || !outputs.images.empty();
  }
  /// Then there is no window.
  bool headless() const { return writes() || !http.empty() || !foxglove.empty(); }
};

/// Draws frames to a window or to files, keeps the one that is shown, and how the stream went until it.
class FrameRenderer {
 public:
  /// Opens the outputs. A key of the window teaches objects of the stream at `lcm_url` ("" = LCM's default) to the
  /// store, if there is one. Throws InputError where there are no models, a store and a folder of models, no display,
  /// no folder to write to, or no address to serve at.
  explicit FrameRenderer(const FrameRendererSettings& settings, const std::string& lcm_url = "");

  /// Shows a frame, unless nobody needs an image, paused, another camera is shown by now, or there is a page without
  /// viewers. A frame that cannot be understood is reported to `watcher` and skipped. Throws InputError where a file
  /// cannot be written.
  void show(const MatchedFrame& matched, BusWatcher& watcher);

  /// Lets window and page act on keys and buttons, one of which shows `watcher`'s next camera. False when it was asked
  /// to end.
  bool handle_keys(BusWatcher& watcher);

  /// These work as in ViewOutputs.
  bool complete() const { return outputs_.complete(); }
  void finish() { outputs_.finish(); }

  /// Returns the models by class, empty without any. May be called from any thread.
  std::shared_ptr<const ClassModels> models() const;

 private:
  std::optional<cv::Mat> drawn(const MatchedFrame& matched, BusWatcher& watcher);
  void look_at_stream(BusWatcher& watcher);
  void serve_page(BusWatcher& watcher);
  cv::Mat draw(const ViewedFrame& viewed) const;
  void teach();
  void remember(const ViewedFrame& viewed);

  std::unique_ptr<ViewWindow> window_;  // first: it forks, which a process does before it has threads
  std::shared_ptr<const ClassModels> models_;
  std::unique_ptr<store::StoreWatcher<ClassModels>> store_;
  std::unique_ptr<LivePage> page_;
  bool page_alone_;     // only the page needs images
  bool draws_nothing_;  // Foxglove draws for itself
  ViewOutputs outputs_;
  std::optional<Camera> camera_;
  FrameViewSettings image_settings_;
  bool preview_;
  std::optional<ViewedFrame> viewed_;
  StreamView stream_;
  TeachingOrder order_;
  TeachingStarter starter_;
};

}  // namespace houghstream::view
