#pragma once

#include <OpenNI.h>

#include <string>
#include <vector>

#include "drivers/openni/camera_options.hpp"
#include "drivers/openni/stream_start.hpp"
#include "drivers/openni/timestamp_pairing.hpp"
#include "pipeline/base/files.hpp"

// The recording of a camera goes to a .oni file. Only the .cpp files of this folder include this header.

namespace houghstream::openni {

/// Records to a .oni file. OpenNI2's recorder lets each stream begin at zero, so that colour and depth that were taken
/// together lie apart in the file wherever their first images were not. The live images show when those were taken,
/// which corrects the times in the file once it is finished.
class OpenniRecording {
 public:
  /// Records to the file that the options name, or to its next number. What a killed program has recorded under that
  /// name is ended, so that it can be played. Throws InputError where the file cannot be written.
  OpenniRecording(const CameraOptions& options, ::openni::VideoStream& depth, ::openni::VideoStream& colour);

  bool started() const { return started_us_ > 0; }
  void start();

  /// Takes note of an image as the camera's users get it.
  void note(const SensorImage& image);

  /// Ends the recording; the streams must still exist, and have been stopped.
  void stop() { recorder_.destroy(); }

  /// Corrects the file after stop(): its times become those of one clock, the earlier stream's first image at zero, and
  /// the file is moved to its final name. Warns where the times cannot be corrected; they are then as OpenNI2 has left
  /// them. An incomplete recording (a full disk) is reported, and stays as FILE.partial.oni; an earlier FILE is left
  /// alone. `first_recorded` reads the first images of a recorded file.
  void finish(FirstImages (*first_recorded)(const std::string& file)) noexcept;

 private:
  void mend_times(const FirstImages& recorded);

  AtomicFile whole_;
  std::string file_;  // while it is written
  bool jpeg_;
  ::openni::Recorder recorder_;
  std::int64_t started_us_ = 0;  // host's time, 0 before
  FirstImages live_;
};

}  // namespace houghstream::openni
