#include "drivers/openni/oni_times.hpp"
#include "drivers/ros_bag/bag_source.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/messages.hpp"
#include "tests/drivers/ros_bag/test_bag.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/tools/log/recordings.hpp"
#include "tools/log/good_events.hpp"
#include "tools/log/klg_file.hpp"

namespace houghstream::fuzz {
namespace {

Taken read_log(ByteView input) {
  log_tools::LossReport losses;
  log_tools::IntactEvents events(as_file(input, "log"), losses);
  Taken taken;
  while (events.next()) ++taken.items;
  taken.tells_loss = !losses.line().empty();
  return taken;
}

std::string write_log() {
  std::string file = as_file({}, "seed_log");
  log_tools::TestLog log(file);
  for (const std::string channel : {"LEFT", "RIGHT"}) log.add_bytes(channel, {1, 2, 3, 4, 5, 6, 7, 8, 9});
  log.close();
  return file;
}

std::vector<Bytes> logs() {
  return {content_of(write_log())};
}

std::vector<Bytes> sealed_logs() {
  const std::string sealed = as_file({}, "seed_sealed_log");
  seal_log(write_log(), sealed);
  return {content_of(sealed)};
}

Taken read_klg(ByteView input) {
  log_tools::KlgFile klg(as_file(input, "klg"), 16, 12);
  Taken taken;
  while (const std::optional<images_t> message = klg.next()) {
    images_from_message(*message);
    ++taken.items;
  }
  return taken;
}

std::vector<Bytes> klgs() {
  log_tools::KlgWriter writer(2);
  writer.add(make_test_frame(5, 16, 12), true);
  writer.add(make_test_frame(6, 16, 12), false);
  const std::string file = as_file({}, "seed_klg");
  writer.save(file);
  return {content_of(file)};
}

Taken read_oni(ByteView input) {
  return {openni::check_oni(as_file(input, "oni"))};
}

/// Returns a file's head, a stream that states two images, those, the times of its seek table, its end.
std::vector<Bytes> onis() {
  Bytes bytes = {'N', 'I', '1', '0', 1, 0, 1, 0, 0, 0, 0, 0};
  bytes.resize(24);
  const auto record = [&](std::uint32_t type, const Bytes& fields, const Bytes& payload) {
    const auto header = 28 + static_cast<std::uint32_t>(fields.size());
    for (const std::uint32_t word :
         {0x0052494EU, type, 1U, header, static_cast<std::uint32_t>(payload.size()), 0U, 0U}) {
      for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
    }
    bytes.insert(bytes.end(), fields.begin(), fields.end());
    bytes.insert(bytes.end(), payload.begin(), payload.end());
  };
  Bytes stream(8 + 28);
  stream[8] = 2;
  record(13, stream, {});
  Bytes table(3 * 20);
  for (const std::size_t number : {1U, 2U}) {
    Bytes image(12);
    image[0] = table[20 * number] = static_cast<std::uint8_t>(33 * number);
    record(10, image, Bytes(16));
  }
  record(14, {}, table);
  record(11, {}, {});
  return {bytes};
}

Taken read_bag(ByteView input) {
  hush_log();  // each bag that is opened says what it holds
  const std::unique_ptr<FrameSource> source = ros_bag::open_bag_source(as_file(input, "bag"));
  Taken taken;
  while (source->next()) ++taken.items;
  return taken;
}

/// Returns one of each compression, with five frames in two chunks.
std::vector<Bytes> bags() {
  std::vector<Bytes> all;
  for (const char* compression : {"none", "bz2", "lz4"}) {
    ros_bag::TestBag recorded(compression);
    for (int i = 0; i < 5; ++i) {
      const RgbdFrame frame = make_test_frame(1'600'000'000'000'000 + 33'333 * i, 16, 12);
      const std::int64_t utime = frame.id.utime;
      const ros_bag::MessageHeader header = {utime, "camera"};
      recorded.add("/rgb/camera_info", ros_bag::kCameraInfoType, ros_bag::camera_info_bytes(header, frame.camera),
                   utime);
      recorded.add("/rgb/image", ros_bag::kImageType, ros_bag::image_bytes(header, frame.colour, "rgb8"), utime);
      recorded.add("/depth/image", ros_bag::kImageType,
                   ros_bag::image_bytes(header, depth_to_millimetres(frame.depth), "16UC1"), utime);
      if (i == 2) recorded.end_chunk();
    }
    all.push_back(recorded.bytes());
  }
  return all;
}

}  // namespace

std::vector<FuzzTarget> recording_targets() {
  const std::string sync = "\xED\xA1\xDA\x01";
  return {// a cut between two events is only detected by a seal
          {"log", read_log, logs, nullptr, {sync}, 4096, {false, 0}},
          {"sealed_log", read_log, sealed_logs, nullptr, {sync, "HSSEAL1"}, 4096, kAnyDamage},
          {"klg", read_klg, klgs, nullptr, {}, 4096, kAnyDamage},
          {"oni", read_oni, onis, nullptr, {"NIR"}, 4096, kAnyDamage},
          // A changed stamp takes a frame its partner, and is told in the log.
          {"bag",
           read_bag,
           bags,
           nullptr,
           {"#ROSBAG V2.0\n", "op=", "conn=", "size=", "compression=lz4", "16UC1", "32FC1", "mono8"},
           16384,
           {true, 2}}};
}

}  // namespace houghstream::fuzz
