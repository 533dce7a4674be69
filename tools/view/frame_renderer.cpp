#include "tools/view/frame_renderer.hpp"

#include <filesystem>
#include <utility>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tools/common/usage_error.hpp"

namespace houghstream::view {
namespace {

ViewedFrame decode(const MatchedFrame& matched, const std::optional<Camera>& camera, const ClassModels& models) {
  const ByteView bytes{matched.frame_bytes.data(), matched.frame_bytes.size()};
  ViewedFrame viewed;
  viewed.frame = frame_from_message(decode_message<houghstream::images_t>(bytes), matched.id.channel, camera);
  viewed.detections.frame = matched.id;
  if (matched.results.followed()) {
    BoxedPoses all = boxed(*matched.results.followed(), models, viewed.frame.camera);
    viewed.detections = std::move(all.detections);
    viewed.poses = std::move(all.poses);
    viewed.pose_latency_ms = matched.pose_latency_ms;
    return viewed;
  }
  if (std::optional<FrameResult> all = matched.results.merge()) {
    viewed.detections = std::move(all->detections);
    viewed.detect_latency_ms = matched.detect_latency_ms;
    viewed.poses = std::move(all->poses);
    if (viewed.poses) viewed.pose_latency_ms = matched.pose_latency_ms;
  }
  return viewed;
}

std::shared_ptr<const ClassModels> load_models(const FrameRendererSettings& settings) {
  require_usage(settings.models.empty() || settings.objects.empty(),
                "expected either --objects STORE or --models FOLDER");
  ClassModels models;
  if (!settings.models.empty()) models = load_class_models(settings.models, settings.model_unit_m);
  return std::make_shared<const ClassModels>(std::move(models));
}

}  // namespace

FrameRenderer::FrameRenderer(const FrameRendererSettings& settings, const std::string& lcm_url)
    : window_(settings.headless() ? nullptr : std::make_unique<ViewWindow>()),
      models_(load_models(settings)),
      page_(settings.http.empty() ? nullptr : std::make_unique<LivePage>(settings.http, settings.http_hosts)),
      page_alone_(page_ && !settings.writes()),
      draws_nothing_(!window_ && !page_ && !settings.writes()),
      outputs_(settings.outputs),
      camera_(settings.camera),
      image_settings_(settings.image),
      preview_(settings.preview) {
  image_settings_.show_keys = window_ != nullptr;
  if (settings.objects.empty()) return;
  store_ = std::make_unique<store::StoreWatcher<ClassModels>>(settings.objects, [](const store::ObjectStore& store) {
    return std::make_shared<const ClassModels>(store::load_store_meshes(store));
  });
  store_->follow();
  image_settings_.can_teach = true;
  order_.executables = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  order_.store = settings.objects;
  order_.lcm_url = lcm_url;
}

void FrameRenderer::show(const MatchedFrame& matched, BusWatcher& watcher) {
  if (draws_nothing_) return watcher.note_drawn(matched);
  const bool unseen = page_alone_ && !page_->has_viewers();
  if (unseen || image_settings_.paused || !watcher.cameras().is_shown(matched.id.channel)) {
    watcher.note_skipped();
    return;
  }
  const std::optional<cv::Mat> image = drawn(matched, watcher);
  if (!image || page_alone_) return;
  if (window_) window_->show(*image, matched.id);
  outputs_.add(*image, matched.id.utime, matched.slot);
  if (!preview_) return;
  try {
    watcher.publish_preview(*image, matched.id.utime);
  } catch (const InputError& error) {
    watcher.note_trouble(error.what());
  }
}

bool FrameRenderer::handle_keys(BusWatcher& watcher) {
  if (page_) serve_page(watcher);
  if (!window_) return true;
  const KeyAction action = window_->handle_keys(image_settings_);
  if (action == KeyAction::kNextCamera) watcher.cameras().next();
  if (action == KeyAction::kTeach) teach();
  starter_.runs();
  if (action == KeyAction::kRedraw && viewed_) window_->show(draw(*viewed_), viewed_->frame.id);
  return action != KeyAction::kEnd;
}

void FrameRenderer::look_at_stream(BusWatcher& watcher) {
  stream_.state = watcher.stream_state();
  stream_.frames_lost = watcher.frames_lost();
  stream_.cameras = watcher.cameras().heard();
}

void FrameRenderer::serve_page(BusWatcher& watcher) {
  const PageCommands commands = page_->pop_commands();
  if (commands.next_camera) watcher.cameras().next();
  image_settings_.paused = commands.paused.value_or(image_settings_.paused);
  image_settings_.min_score = commands.min_score.value_or(image_settings_.min_score);
  if (commands.empty() && !page_->is_due()) return;
  look_at_stream(watcher);
  try {
    if (commands.min_score && viewed_) page_->show({*viewed_, *models(), image_settings_, stream_});
    page_->catch_up(viewed_, *models(), image_settings_, stream_);
  } catch (const std::exception& error) {  // OpenCV's too: no frame may end the program
    watcher.note_trouble(error.what());
  }
}

std::shared_ptr<const ClassModels> FrameRenderer::models() const {
  const std::shared_ptr<const ClassModels> of_store = store_ ? store_->current() : nullptr;
  return of_store ? of_store : models_;
}

void FrameRenderer::teach() {
  if (!store_) log_warning("key t teaches into an object store, expected --objects STORE");
  if (!store_ || !viewed_) return;
  std::vector<std::string> known;
  for (const KnownObject& object : store_->known().objects) known.push_back(object.name);
  order_.name = free_name(known);
  // A store that was made a moment ago may not be loaded yet.
  order_.joins_others = !known.empty() || std::filesystem::exists(std::filesystem::path(order_.store) / "store.json");
  order_.channel = viewed_->frame.id.channel;
  const cv::Rect image({}, viewed_->frame.colour.size());
  const cv::Rect box = image_settings_.box & image;
  order_.box = box.empty() ? std::nullopt : std::optional<cv::Rect>(box);
  order_.at = image_settings_.at && image.contains(*image_settings_.at) ? image_settings_.at : std::nullopt;
  image_settings_.box = {};
  image_settings_.at.reset();
  starter_.press(order_);
}

std::optional<cv::Mat> FrameRenderer::drawn(const MatchedFrame& matched, BusWatcher& watcher) {
  try {
    ViewedFrame viewed = decode(matched, camera_, *models());
    remember(viewed);
    look_at_stream(watcher);
    if (page_) page_->show({viewed, *models(), image_settings_, stream_});
    cv::Mat image = page_alone_ ? cv::Mat() : draw(viewed);
    viewed_ = std::move(viewed);
    watcher.note_drawn(matched);
    return image;
  } catch (const std::exception& error) {  // OpenCV's too: no frame may end the program
    watcher.note_refused(error.what());
    return std::nullopt;
  }
}

cv::Mat FrameRenderer::draw(const ViewedFrame& viewed) const {
  return draw_frame_view(viewed, *models(), image_settings_, stream_);
}

void FrameRenderer::remember(const ViewedFrame& viewed) {
  constexpr std::size_t kFrames = 200;
  if (viewed.poses) {
    stream_.history.push_back({viewed.poses->stages, viewed.pose_latency_ms});
  } else {
    stream_.history.push_back({viewed.detections.stages, viewed.detect_latency_ms});
  }
  if (stream_.history.size() > kFrames) stream_.history.pop_front();
}

}  // namespace houghstream::view
