#include "tools/view/view_outputs.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/recording_names.hpp"

namespace houghstream::view {
namespace {

namespace fs = std::filesystem;

void require_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  require(file.empty() || fs::is_directory(folder), "{}: found no folder {}, expected one that is there", file.string(),
          folder.string());
}

void make_folder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  require_folder(folder.has_filename() ? folder : folder.parent_path());  // "new/" is named as well as "new"
  fs::create_directory(folder, error);
  require(fs::is_directory(folder), "{}: folder cannot be made: {}", folder.string(), error.message());
}

}  // namespace

void save_image(const fs::path& file, const cv::Mat& image) {
  write_image(image, file);
}

ViewOutputs::ViewOutputs(OutputSettings settings) : settings_(std::move(settings)) {
  require_folder(settings_.snapshot);
  require_folder(settings_.video);
  make_folder(settings_.images);
  if (!settings_.snapshot.empty()) {
    require_image_format(settings_.snapshot);
    require_writable(settings_.snapshot);
  }
  if (settings_.video.empty()) return;
  video_ = std::make_unique<VideoFile>(settings_.video, settings_.rate_hz, existing_of_recording(settings_.replace));
}

void ViewOutputs::add(const cv::Mat& image, std::int64_t utime, std::int64_t slot) {
  ++added_;
  last_ = image;
  if (video_) video_->add(image, slot);
  if (!settings_.images.empty()) {
    save_image(name_for(settings_.images / fmt::format("{}.jpg", utime)), image);
  }
  if (!settings_.snapshot.empty() && added_ == settings_.snapshot_after) {
    save_snapshot(image);
  }
}

void ViewOutputs::finish() {
  const bool wanted = !settings_.snapshot.empty() || !settings_.video.empty() || !settings_.images.empty();
  require(!wanted || added_ > 0, "nothing to write: no frame was seen on the bus");
  if (!settings_.snapshot.empty() && !snapshot_written_) save_snapshot(last_);
  if (video_) video_->finish();
  video_.reset();
}

fs::path ViewOutputs::name_for(const fs::path& wanted) const {
  return settings_.replace ? wanted : next_recording_name(wanted);
}

void ViewOutputs::save_snapshot(const cv::Mat& image) {
  const fs::path file = name_for(settings_.snapshot);
  save_image(file, image);
  snapshot_written_ = true;
  if (file != settings_.snapshot)
    log_warning("{}: is there and stays; the snapshot goes to {}", settings_.snapshot.string(), file.string());
}

bool ViewOutputs::complete() const {
  return snapshot_written_ && settings_.video.empty() && settings_.images.empty();
}

}  // namespace houghstream::view
