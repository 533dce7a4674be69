#include "drivers/openni/openni_recording.hpp"

#include <algorithm>
#include <cstdlib>

#include "drivers/openni/oni_repair.hpp"
#include "drivers/openni/oni_times.hpp"
#include "drivers/openni/openni_parts.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/host_clock.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/recording_log.hpp"
#include "pipeline/base/service_notice.hpp"

namespace houghstream::openni {
namespace {

constexpr std::size_t kMaxThumbnails = 300;  // ten seconds: as late as a sleeping disk may let the recorder begin

/// A file that cannot be repaired stays as it is.
void end_interrupted(const std::filesystem::path& file) {
  try {
    const std::size_t images = repair_oni(file);
    log_info("{}: is ended and can be played, {} images; colour may lie an image beside its depth", file.string(),
             images);
  } catch (const InputError& error) {
    log_warning("{}", error.what());
  }
}

}  // namespace

OpenniRecording::OpenniRecording(const CameraOptions& options, ::openni::VideoStream& depth,
                                 ::openni::VideoStream& colour)
    : whole_(options.record, ".partial.oni", existing_of_recording(options.replace_record)),
      file_(whole_.partial().string()),
      jpeg_(options.record_jpeg) {
  log_recording_names(whole_);
  if (whole_.interrupted()) end_interrupted(*whole_.interrupted());
  check_openni(recorder_.create(file_.c_str()), file_ + ": cannot be recorded to");
  check_openni(recorder_.attach(depth, false), file_ + ": depth");
  check_openni(recorder_.attach(colour, jpeg_), file_ + ": colour");
}

void OpenniRecording::start() {
  started_us_ = utime_now();
  check_openni(recorder_.start(), file_ + ": recording");
}

void OpenniRecording::note(const SensorImage& image) {
  std::vector<ImageThumbnail>& thumbnails = live_.of(image.sensor);
  const bool may_be_recorded = started() && image.host_us >= started_us_;
  if (may_be_recorded && thumbnails.size() < kMaxThumbnails) thumbnails.push_back(make_thumbnail(image));
}

void OpenniRecording::mend_times(const FirstImages& recorded) {
  const std::optional<RecordedStarts> starts = find_stream_starts(recorded, live_);
  require(starts && starts->depth.difference == 0.0 && (jpeg_ || starts->colour.difference == 0.0),
          "{}: its first images are not among those seen", file_);
  const std::int64_t colour_later_us = starts->colour.device_us - starts->depth.device_us;
  const OniNode later = colour_later_us > 0 ? OniNode::kSecond : OniNode::kFirst;
  if (colour_later_us != 0) delay_oni_node(file_, later, std::abs(colour_later_us));
}

void OpenniRecording::finish(FirstImages (*first_recorded)(const std::string& file)) noexcept {
  const StillFinishing finishing;  // a long recording is read from its disk
  FirstImages recorded;
  try {
    check_oni(file_);
    recorded = first_recorded(file_);
  } catch (const std::exception& error) {
    whole_.keep_partial();  // a camera's recording cannot be repeated
    log_error("{}; the recording is not whole and stays there, {} is what it was", error.what(),
              whole_.file().string());
    return;
  }
  try {
    mend_times(recorded);
  } catch (const std::exception& error) {
    log_warning("{}; in the recording colour may lie beside its depth", error.what());
  }
  try {
    whole_.commit();
  } catch (const std::exception& error) {
    log_error("{}", error.what());
  }
}

}  // namespace houghstream::openni
