#include "drivers/ros_bag/bag_source.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "drivers/ros_bag/bag_images.hpp"
#include "drivers/ros_bag/bag_topics.hpp"
#include "drivers/ros_bag/stamp_pairing.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream::ros_bag {
namespace {

/// Holds what the words of "FILE,KEY=VALUE,..." ask for.
struct BagOptions {
  std::string file;
  WantedTopics topics;
  std::optional<Camera> camera;
};

void set_option(BagOptions& options, const std::string& key, const std::string& value) {
  const std::pair<const char*, std::string*> topics[] = {{"depth", &options.topics.depth},
                                                         {"colour", &options.topics.colour},
                                                         {"color", &options.topics.colour},
                                                         {"info", &options.topics.info}};
  for (const auto& [name, topic] : topics) {
    if (key != name) continue;
    require(!value.empty(), "bag:{}: {}= without a topic, expected one", options.file, key);
    *topic = value.front() == '/' ? value : "/" + value;
    return;
  }
  require(key == "camera", "bag:{}: '{}', expected depth=TOPIC, colour=TOPIC, info=TOPIC or camera=CAMERA",
          options.file, printable(key));
  options.camera = parse_camera(value);
}

/// A file's name may hold commas too: the longest that is there counts.
BagOptions parse_options(const std::string& value) {
  const auto is_there = [](const std::string& name) {
    std::error_code unknown;
    return std::filesystem::exists(name, unknown);
  };
  BagOptions options;
  options.file = value;
  while (!is_there(options.file) && options.file.find(',') != std::string::npos)
    options.file.resize(options.file.rfind(','));
  std::vector<std::string> words;  // KEY=VALUE, whose value may hold commas
  for (std::size_t begin = options.file.size() + 1; begin <= value.size();) {
    const std::size_t end = std::min(value.find(',', begin), value.size());
    const std::string word = value.substr(begin, end - begin);
    if (words.empty() || word.find('=') != std::string::npos) {
      words.push_back(word);
    } else {
      words.back() += "," + word;
    }
    begin = end + 1;
  }
  for (const std::string& word : words) {
    const std::size_t equals = std::min(word.find('='), word.size());
    set_option(options, word.substr(0, equals), equals == word.size() ? "" : word.substr(equals + 1));
  }
  return options;
}

/// Returns the median time between the first images of a topic by their stamps, in microseconds; nothing where there
/// are fewer than two.
std::optional<std::int64_t> median_period_us(BagFile& file, const ChosenTopic& topic) {
  constexpr std::size_t kImages = 31;
  std::vector<std::int64_t> stamps;
  BagMessages messages(file, topic.connections);
  while (stamps.size() < kImages) {
    const std::optional<BagMessage> message = messages.next();
    if (!message) break;
    stamps.push_back(parse_header(message->range(), file.name() + ", " + printable(topic.name)).stamp_us);
  }
  std::sort(stamps.begin(), stamps.end());
  stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
  if (stamps.size() < 2) return std::nullopt;
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < stamps.size(); ++i) periods.push_back(stamps[i] - stamps[i - 1]);
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

class BagSource : public FrameSource {
 public:
  explicit BagSource(const BagOptions& options)
      : file_(options.file),
        topics_(choose_topics(file_, options.topics)),
        camera_(options.camera ? *options.camera : read_camera()),
        depth_period_us_(period_us(topics_.depth)),
        period_us_(std::max(depth_period_us_, period_us(topics_.colour))),
        messages_(file_, image_connections()),
        pairing_(tolerance_us()) {
    log_info("{}: depth of {}, colour of {}, camera of {}, {:.3g} Hz", file_.name(), printable(topics_.depth.name),
             printable(topics_.colour.name), options.camera ? "the command line" : printable(topics_.info.name),
             rate_hz());
    if (is_registered(topics_)) return;
    log_warning(
        "{}: depth of {} is in frame '{}', colour in '{}': taken as registered to colour; where it is not, boxes and "
        "poses "
        "are wrong",
        file_.name(), printable(topics_.depth.name), printable(topics_.depth.frame_id),
        printable(topics_.colour.frame_id));
  }

  ~BagSource() override { report_unpaired(); }
  BagSource(const BagSource&) = delete;
  BagSource& operator=(const BagSource&) = delete;

  std::optional<RgbdFrame> next() override {
    while (true) {
      if (const std::optional<StampedPair> pair = pairing_.pop()) return frame_of(*pair);
      if (is_ended_) break;
      if (std::optional<BagMessage> message = messages_.next()) {
        add(std::move(*message));
      } else {
        pairing_.end();
        is_ended_ = true;
      }
    }
    require_frames();
    return std::nullopt;
  }

  double rate_hz() const override { return 1e6 / static_cast<double>(period_us_); }

 private:
  std::string source_of(const ChosenTopic& topic) const { return file_.name() + ", " + printable(topic.name); }

  Camera read_camera() {
    require(!topics_.info.name.empty(),
            "{}: no camera_info beside {} or {}, expected one; bag:FILE,info=TOPIC or "
            "bag:FILE,camera=WIDTHxHEIGHT,fx,fy,cx,cy names the camera",
            file_.name(), printable(topics_.colour.name), printable(topics_.depth.name));
    const std::optional<BagMessage> message = BagMessages(file_, topics_.info.connections).next();
    require(message.has_value(), "{}: no message, expected one", source_of(topics_.info));
    return camera_of_info(parse_camera_info(message->range(), source_of(topics_.info)),
                          is_rectified(topics_.colour.name), source_of(topics_.info));
  }

  std::int64_t period_us(const ChosenTopic& topic) {
    constexpr std::int64_t kUsual = 33'333;  // of a topic with one image
    constexpr std::int64_t kMin = 1000;
    return std::max(kMin, median_period_us(file_, topic).value_or(kUsual));
  }

  std::set<std::uint32_t> image_connections() const {
    std::set<std::uint32_t> connections = topics_.depth.connections;
    connections.insert(topics_.colour.connections.begin(), topics_.colour.connections.end());
    return connections;
  }

  void add(BagMessage message) {
    const bool is_depth = topics_.depth.connections.count(message.connection) > 0;
    const ChosenTopic& topic = is_depth ? topics_.depth : topics_.colour;
    StampedImage image;
    image.stamp_us = parse_header(message.range(), source_of(topic)).stamp_us;
    require(image.stamp_us > 0, "{}: a message without a stamp in its header, expected the time of capture",
            source_of(topic));
    image.message = std::move(message);
    if (is_depth) {
      pairing_.add_depth(std::move(image));
    } else {
      pairing_.add_colour(std::move(image));
    }
  }

  RgbdFrame frame_of(const StampedPair& pair) {
    const auto source = [&](const ChosenTopic& topic, const StampedImage& image) {
      return fmt::format("{}, image at {}.{:06} s", source_of(topic), image.stamp_us / 1'000'000,
                         image.stamp_us % 1'000'000);
    };
    const std::string depth = source(topics_.depth, pair.depth);
    const std::string colour = source(topics_.colour, pair.colour);
    RgbdFrame frame;
    frame.id.utime = pair.depth.stamp_us;
    frame.camera = camera_;
    frame.depth = decode_depth(parse_image(pair.depth.message.range(), topics_.depth.type, depth), depth);
    frame.colour = decode_colour(parse_image(pair.colour.message.range(), topics_.colour.type, colour), colour);
    check_frame(frame, depth);
    ++frames_;
    return frame;
  }

  std::int64_t tolerance_us() const { return depth_period_us_ / 2; }
  double tolerance_ms() const { return static_cast<double>(tolerance_us()) / 1e3; }

  void require_frames() const {
    const UnpairedCounts& unpaired = pairing_.unpaired();
    require(
        frames_ > 0,
        "{}: no colour image of {} within {:.1f} ms of a depth image of {}, by the stamps in their headers: {} and {} "
        "images",
        file_.name(), printable(topics_.colour.name), tolerance_ms(), printable(topics_.depth.name), unpaired.colour,
        unpaired.depth);
  }

  /// Logs what was left out until the end, or until as many frames were taken as were wanted.
  void report_unpaired() const noexcept {
    const UnpairedCounts& unpaired = pairing_.unpaired();
    if (frames_ == 0 || unpaired.all() == 0) return;
    log_warning(
        "{}: {} frames; left out: {} depth and {} colour images without a partner within {:.1f} ms, {} depth images "
        "with "
        "the stamp of another",
        file_.name(), frames_, unpaired.depth, unpaired.colour, tolerance_ms(), unpaired.repeated);
  }

  BagFile file_;
  ChosenTopics topics_;
  Camera camera_;
  std::int64_t depth_period_us_;  // between two depth images
  std::int64_t period_us_;        // between two frames
  BagMessages messages_;
  StampPairing pairing_;
  bool is_ended_ = false;
  std::int64_t frames_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_bag_source(const std::string& value) {
  return std::make_unique<BagSource>(parse_options(value));
}

}  // namespace houghstream::ros_bag
