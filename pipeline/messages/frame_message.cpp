#include <algorithm>
#include <cstring>
#include <houghstream/camera_t.hpp>
#include <houghstream/stage_time_t.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/codecs.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "depth travels little-endian and is copied as it is");

namespace houghstream {
namespace {

void add_metadata(images_t& message, const std::string& key, std::vector<std::uint8_t> value) {
  require(!message.images.empty(), "frame {}: no images", message.utime);
  image_t& image = message.images[0];
  image_metadata_t entry;
  entry.key = key;
  entry.n = static_cast<std::int32_t>(value.size());
  entry.value = std::move(value);
  image.metadata.push_back(std::move(entry));
  image.nmetadata = static_cast<std::int32_t>(image.metadata.size());
}

std::vector<std::uint8_t> encode_stages(const std::vector<StageTime>& stages) {
  std::vector<std::uint8_t> all;
  for (const StageTime& stage : stages) {
    stage_time_t message;
    message.stage = stage.stage;
    message.duration_us = stage.duration_us;
    const std::vector<std::uint8_t> bytes = encode_message(message);
    all.insert(all.end(), bytes.begin(), bytes.end());
  }
  return all;
}

std::vector<std::uint8_t> encode_camera(const Camera& camera) {
  camera_t message;
  message.width = camera.width;
  message.height = camera.height;
  message.fx = camera.fx;
  message.fy = camera.fy;
  message.cx = camera.cx;
  message.cy = camera.cy;
  return encode_message(message);
}

image_t empty_image(const RgbdFrame& frame) {
  image_t image{};
  image.utime = frame.id.utime;
  image.width = frame.colour.cols;
  image.height = frame.colour.rows;
  return image;
}

void set_data(image_t& image, std::vector<std::uint8_t> data) {
  image.size = static_cast<std::int32_t>(data.size());
  image.data = std::move(data);
}

std::vector<std::uint8_t> bytes_of(const cv::Mat& continuous) {
  return {continuous.data, continuous.data + continuous.total() * continuous.elemSize()};
}

image_t colour_image(const RgbdFrame& frame, const WireFormat& format) {
  image_t image = empty_image(frame);
  if (format.jpeg) {
    image.pixelformat = image_t::PIXEL_FORMAT_MJPEG;
    set_data(image, encode_jpeg(frame.colour, format.jpeg_quality));
  } else {
    cv::Mat rgb;
    cv::cvtColor(frame.colour, rgb, cv::COLOR_BGR2RGB);
    image.pixelformat = image_t::PIXEL_FORMAT_RGB;
    image.row_stride = 3 * image.width;
    set_data(image, bytes_of(rgb));
  }
  return image;
}

image_t depth_image(const RgbdFrame& frame, const WireFormat& format) {
  const cv::Mat depth_mm = depth_to_millimetres(frame.depth);
  image_t image = empty_image(frame);
  image.pixelformat = image_t::PIXEL_FORMAT_LE_GRAY16;
  image.row_stride = format.zip_depth ? 0 : 2 * image.width;
  set_data(image, format.zip_depth ? zip_depth(depth_mm, format.zip_level) : bytes_of(depth_mm));
  return image;
}

// Returns a raw image as a matrix of its own, without the padding that a row may end with. row_stride 0 means none.
cv::Mat unpack_raw(const image_t& image, int type) {
  check_image_size(image.width, image.height);
  const std::int64_t row_bytes = static_cast<std::int64_t>(image.width) * static_cast<std::int64_t>(CV_ELEM_SIZE(type));
  const std::int64_t stride = image.row_stride == 0 ? row_bytes : image.row_stride;
  require(stride >= row_bytes, "row stride of {} bytes, expected at least {} for {} pixels", image.row_stride,
          row_bytes, image.width);
  const std::int64_t minimum = stride * (image.height - 1) + row_bytes;
  require(image.size >= minimum && image.size <= stride * image.height,
          "raw image of {} bytes, expected {} for {}x{} pixels with row stride {}", image.size, stride * image.height,
          image.width, image.height, stride);
  cv::Mat out(image.height, image.width, type);
  for (int y = 0; y < out.rows; ++y) {
    std::memcpy(out.ptr(y), image.data.data() + y * stride, static_cast<std::size_t>(row_bytes));
  }
  return out;
}

cv::Mat decode_colour(const image_t& image) {
  cv::Mat bgr;
  switch (image.pixelformat) {
    case image_t::PIXEL_FORMAT_MJPEG:
      return decode_jpeg({image.data.data(), image.data.size()}, image.width, image.height);
    case image_t::PIXEL_FORMAT_BGR: return unpack_raw(image, CV_8UC3);
    case image_t::PIXEL_FORMAT_RGB: cv::cvtColor(unpack_raw(image, CV_8UC3), bgr, cv::COLOR_RGB2BGR); return bgr;
    case image_t::PIXEL_FORMAT_RGBA: cv::cvtColor(unpack_raw(image, CV_8UC4), bgr, cv::COLOR_RGBA2BGR); return bgr;
    case image_t::PIXEL_FORMAT_BGRA: cv::cvtColor(unpack_raw(image, CV_8UC4), bgr, cv::COLOR_BGRA2BGR); return bgr;
    case image_t::PIXEL_FORMAT_GRAY: cv::cvtColor(unpack_raw(image, CV_8UC1), bgr, cv::COLOR_GRAY2BGR); return bgr;
    default: break;
  }
  fail("colour of pixel format {}, expected RGB, BGR, RGBA, BGRA, GRAY or MJPEG", image.pixelformat);
}

cv::Mat decode_depth(const image_t& image, bool zipped) {
  if (zipped) return unzip_depth({image.data.data(), image.data.size()}, image.width, image.height);
  return unpack_raw(image, CV_16UC1);
}

std::size_t find_image(const images_t& message, std::initializer_list<std::int16_t> types, const char* what) {
  for (std::size_t i = 0; i < message.image_types.size() && i < message.images.size(); ++i) {
    if (std::count(types.begin(), types.end(), message.image_types[i]) > 0) return i;
  }
  fail("no {} image among {}", what, message.images.size());
}

const image_metadata_t* find_metadata(const images_t& message, const std::string& key) {
  for (const image_t& image : message.images) {
    for (const image_metadata_t& entry : image.metadata) {
      if (entry.key == key) return &entry;
    }
  }
  return nullptr;
}

Camera camera_or(const images_t& message, const std::optional<Camera>& fallback_camera) {
  const std::optional<Camera> from_metadata = read_camera_metadata(message);
  require(from_metadata || fallback_camera, "no camera in its metadata; give --camera WIDTHxHEIGHT,fx,fy,cx,cy");
  return from_metadata ? *from_metadata : *fallback_camera;
}

std::vector<StageTime> stages_of(const images_t& message) {
  std::vector<StageTime> stages;
  const image_metadata_t* entry = find_metadata(message, metadata::kStages);
  if (entry == nullptr) return stages;
  WireReader reader({entry->value.data(), entry->value.size()}, metadata::kStages);
  while (reader.left() > 0) {
    require(reader.read_int64() == stage_time_t::getHash(), "metadata '{}' is not a list of stage_time_t",
            metadata::kStages);
    // Half of what a result may have: who works on the frame adds his own.
    require(stages.size() < kMaxStages / 2, "metadata '{}' lists more than {} stages", metadata::kStages,
            kMaxStages / 2);
    std::string stage = reader.read_string();
    require(stage.size() <= kMaxNameLength, "metadata '{}' names a stage of {} bytes, expected at most {}",
            metadata::kStages, stage.size(), kMaxNameLength);
    stages.push_back({std::move(stage), reader.read_int64()});
    check_stage_time(stages.back().duration_us, metadata::kStages);
  }
  return stages;
}

/// Refers to the colour and the depth image of a message.
struct FoundImages {
  const image_t& colour;
  const image_t& depth;
  bool zipped_depth;
};

FoundImages find_images(const images_t& message) {
  const std::size_t colour = find_image(message, {images_t::LEFT}, "colour (LEFT)");
  const std::size_t depth = find_image(message, {images_t::DEPTH_MM, images_t::DEPTH_MM_ZIPPED}, "DEPTH_MM");
  const FoundImages found{message.images[colour], message.images[depth],
                          message.image_types[depth] == images_t::DEPTH_MM_ZIPPED};
  require(found.colour.width == found.depth.width && found.colour.height == found.depth.height,
          "colour of {}x{} and depth of {}x{} pixels, expected depth registered to colour", found.colour.width,
          found.colour.height, found.depth.width, found.depth.height);
  return found;
}

FrameImages decode_images(const images_t& message) {
  const FoundImages found = find_images(message);
  return {decode_colour(found.colour), decode_depth(found.depth, found.zipped_depth)};
}

/// Returns the frame without its images.
RgbdFrame undecoded_frame(const images_t& message, const std::string& channel,
                          const std::optional<Camera>& fallback_camera) {
  RgbdFrame frame;
  frame.id = {channel, message.utime};
  frame.camera = camera_or(message, fallback_camera);
  frame.stages = stages_of(message);
  return frame;
}

RgbdFrame decode_frame(const images_t& message, const std::string& channel,
                       const std::optional<Camera>& fallback_camera) {
  const FoundImages found = find_images(message);
  RgbdFrame frame = undecoded_frame(message, channel, fallback_camera);
  parallel_for(2, 2, [&](int image) {
    if (image == 0) frame.colour = decode_colour(found.colour);
    if (image == 1) frame.depth = depth_from_millimetres(decode_depth(found.depth, found.zipped_depth));
  });
  check_frame(frame, "its camera");
  return frame;
}

RgbdFrame decode_without_colour(const images_t& message, const std::string& channel,
                                const std::optional<Camera>& fallback_camera) {
  const FoundImages found = find_images(message);
  RgbdFrame frame = undecoded_frame(message, channel, fallback_camera);
  check_camera(frame.camera, "its camera");
  require(found.depth.width == frame.camera.width && found.depth.height == frame.camera.height,
          "its camera: depth {}x{} and camera {}x{}, expected equal sizes", found.depth.width, found.depth.height,
          frame.camera.width, frame.camera.height);
  frame.depth = depth_from_millimetres(decode_depth(found.depth, found.zipped_depth));
  return frame;
}

/// Returns the result of `decode` for a message; its errors name the frame.
template <typename Decode>
auto decode_named(const FrameId& frame, const Decode& decode) {
  try {
    return decode();
  } catch (const InputError& error) {
    fail("frame {}: {}", to_string(frame), error.what());
  }
}

}  // namespace

images_t to_message(const RgbdFrame& frame, const WireFormat& format, std::int64_t sequence) {
  check_frame(frame, "frame to send");
  images_t message{};
  message.utime = frame.id.utime;
  message.n_images = 2;
  const std::int16_t depth_type = format.zip_depth ? images_t::DEPTH_MM_ZIPPED : images_t::DEPTH_MM;
  message.image_types = {images_t::LEFT, depth_type};
  message.images = {colour_image(frame, format), depth_image(frame, format)};
  add_camera(message, frame.camera);
  add_metadata(message, metadata::kStages, encode_stages(frame.stages));
  add_sequence(message, sequence);
  return message;
}

void add_camera(images_t& message, const Camera& camera) {
  check_camera(camera, "camera to send");
  add_metadata(message, metadata::kCamera, encode_camera(camera));
}

void add_sequence(images_t& message, std::int64_t sequence) {
  const std::string counter = std::to_string(sequence);
  add_metadata(message, metadata::kSequence, {counter.begin(), counter.end()});
}

void add_run(images_t& message, std::int64_t run) {
  const std::string text = std::to_string(run);
  add_metadata(message, metadata::kRun, {text.begin(), text.end()});
}

RgbdFrame frame_from_message(const images_t& message, const std::string& channel,
                             const std::optional<Camera>& fallback_camera) {
  return decode_named({channel, message.utime}, [&] { return decode_frame(message, channel, fallback_camera); });
}

RgbdFrame depth_frame_from_message(const images_t& message, const std::string& channel,
                                   const std::optional<Camera>& fallback_camera) {
  return decode_named({channel, message.utime},
                      [&] { return decode_without_colour(message, channel, fallback_camera); });
}

FrameImages images_from_message(const images_t& message) {
  return decode_named({"", message.utime}, [&] { return decode_images(message); });
}

std::optional<Camera> read_camera_metadata(const images_t& message) {
  const image_metadata_t* entry = find_metadata(message, metadata::kCamera);
  if (entry == nullptr) return std::nullopt;
  camera_t stored{};
  const int size = static_cast<int>(entry->value.size());
  require(stored.decode(entry->value.data(), 0, size) == size, "metadata '{}' of {} bytes is not a camera_t",
          metadata::kCamera, size);
  return Camera{stored.width, stored.height, stored.fx, stored.fy, stored.cx, stored.cy};
}

std::optional<std::int64_t> read_sequence_number(const images_t& message) {
  const image_metadata_t* entry = find_metadata(message, metadata::kSequence);
  if (entry == nullptr) return std::nullopt;
  return parse_sequence({entry->value.data(), entry->value.size()});
}

}  // namespace houghstream
