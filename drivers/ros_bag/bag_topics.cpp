#include "drivers/ros_bag/bag_topics.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include "drivers/ros_bag/bag_images.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream::ros_bag {
namespace {

struct ImageTopic {
  ChosenTopic topic;
  std::string encoding;
  ImageKind kind = ImageKind::kOther;
};
using ImageTopics = std::vector<ImageTopic>;

std::vector<std::string> parts_of(const std::string& topic) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < topic.size();) {
    const std::size_t end = std::min(topic.find('/', begin), topic.size());
    if (end > begin) parts.push_back(topic.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool has(const std::string& topic, const char* word) {
  return topic.find(word) != std::string::npos;
}

bool is_infrared(const std::string& topic) {
  const std::vector<std::string> parts = parts_of(topic);
  return std::any_of(parts.begin(), parts.end(), [](const std::string& part) {
    return part == "ir" || part.rfind("infra", 0) == 0 || part.rfind("Infra", 0) == 0 || part == "confidence";
  });
}

bool is_called_depth(const std::string& topic) {
  return has(topic, "depth") || has(topic, "Depth");
}

bool is_called_registered(const std::string& topic) {
  return has(topic, "registered") || has(topic, "aligned");
}

/// Returns the topic whose images a compressed one holds; others themselves.
std::string uncompressed(const std::string& topic) {
  for (const char* end : {"/compressedDepth", "/compressed"})
    if (ends_with(topic, end)) return topic.substr(0, topic.size() - std::string(end).size());
  return topic;
}

std::string namespace_of(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos ? "" : topic.substr(0, slash);
}

std::size_t common_parts(const std::string& a, const std::string& b) {
  const std::vector<std::string> left = parts_of(namespace_of(uncompressed(a)));
  const std::vector<std::string> right = parts_of(namespace_of(uncompressed(b)));
  const auto differ = std::mismatch(left.begin(), left.end(), right.begin(), right.end());
  return static_cast<std::size_t>(differ.first - left.begin());
}

/// Collects the topics of these types, in the order of their names, with the connections of all publishers.
std::vector<ChosenTopic> topics_of(const BagFile& file, const std::vector<std::string>& types) {
  std::map<std::string, ChosenTopic> topics;
  for (const BagConnection& connection : file.connections()) {
    if (std::find(types.begin(), types.end(), connection.type) == types.end()) continue;
    ChosenTopic& topic = topics[connection.topic + " " + connection.type];
    topic.name = connection.topic;
    topic.type = connection.type;
    topic.connections.insert(connection.id);
  }
  std::vector<ChosenTopic> sorted;
  sorted.reserve(topics.size());
  for (auto& [key, topic] : topics) sorted.push_back(std::move(topic));
  return sorted;
}

ImageTopics image_topics_of(BagFile& file) {
  ImageTopics topics;
  for (ChosenTopic& topic : topics_of(file, {kImageType, kCompressedImageType})) {
    const std::optional<BagMessage> first = BagMessages(file, topic.connections).next();
    if (!first) continue;
    const ImageMessage image = parse_image(first->range(), topic.type, file.name() + ", " + printable(topic.name));
    topic.frame_id = image.header.frame_id;
    topics.push_back({std::move(topic), image.encoding, kind_of_image(image)});
  }
  return topics;
}

std::string text_of(const ImageTopics& topics) {
  std::vector<std::string> texts;
  for (const ImageTopic& topic : topics)
    texts.push_back(fmt::format("{} ({})", printable(topic.topic.name), printable(topic.encoding)));
  return texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, ", "));
}

using Accept = std::function<bool(const ImageTopic&)>;

ImageTopics filtered(const ImageTopics& topics, const Accept& accept) {
  ImageTopics some;
  std::copy_if(topics.begin(), topics.end(), std::back_inserter(some), accept);
  return some;
}

/// Returns those that are accepted, or all where none is.
ImageTopics preferred(const ImageTopics& topics, const Accept& accept) {
  ImageTopics some = filtered(topics, accept);
  return some.empty() ? topics : some;
}

/// Throws InputError unless all are images of one camera, of which the best is returned.
ChosenTopic best_of_one_camera(const ImageTopics& topics, const std::string& file, const char* option) {
  const auto rank = [](const ImageTopic& topic) {
    const std::string& name = topic.topic.name;
    const bool is_compressed = topic.topic.type == kCompressedImageType;
    return std::make_tuple(!is_rectified(name), is_compressed, topic.encoding == "32FC1", name.size(), name);
  };
  const auto is_beside_first = [&](const ImageTopic& topic) {
    return namespace_of(uncompressed(topic.topic.name)) == namespace_of(uncompressed(topics.front().topic.name));
  };
  require(std::all_of(topics.begin(), topics.end(), is_beside_first),
          "{}: several {} topics: {}; expected a choice: bag:FILE,{}=TOPIC", file, option, text_of(topics), option);
  return std::min_element(topics.begin(), topics.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); })
      ->topic;
}

ChosenTopic wanted_topic(const ImageTopics& topics, const std::string& wanted, const std::string& file,
                         const Accept& accept, const char* option) {
  const ImageTopics named = filtered(topics, [&](const ImageTopic& topic) { return topic.topic.name == wanted; });
  require(!named.empty(), "{}: no images on topic {}, expected one of {}", file, printable(wanted), text_of(topics));
  const ImageTopics fitting = filtered(named, accept);
  require(!fitting.empty(), "{}: topic {}, expected {}", file, text_of(named), option);
  return fitting.front().topic;
}

ChosenTopic choose_depth(const ImageTopics& topics, const std::string& wanted, const std::string& file) {
  const Accept is_depth = [](const ImageTopic& topic) { return topic.kind == ImageKind::kDepth; };
  if (!wanted.empty())
    return wanted_topic(topics, wanted, file, is_depth, "depth (16UC1, mono16, 32FC1, compressedDepth)");
  ImageTopics depth =
      filtered(filtered(topics, is_depth), [](const ImageTopic& topic) { return !is_infrared(topic.topic.name); });
  require(!depth.empty(), "{}: no depth, expected a topic of 16UC1, mono16, 32FC1 or compressedDepth; its images: {}",
          file, text_of(topics));
  depth = preferred(depth, [](const ImageTopic& topic) { return is_called_depth(topic.topic.name); });
  depth = preferred(depth, [](const ImageTopic& topic) { return is_called_registered(topic.topic.name); });
  return best_of_one_camera(depth, file, "depth");
}

ChosenTopic choose_colour(const ImageTopics& topics, const std::string& wanted, const std::string& file,
                          const std::string& depth) {
  const Accept is_any = [](const ImageTopic& topic) {
    return topic.kind == ImageKind::kColour || topic.kind == ImageKind::kGrey;
  };
  if (!wanted.empty())
    return wanted_topic(topics, wanted, file, is_any, "colour (rgb8, bgr8, rgba8, bgra8, mono8, JPEG, PNG)");
  ImageTopics colour =
      filtered(filtered(topics, is_any), [](const ImageTopic& topic) { return !is_infrared(topic.topic.name); });
  require(!colour.empty(),
          "{}: no colour, expected a topic of rgb8, bgr8, rgba8, bgra8, mono8, JPEG or PNG; its images: {}", file,
          text_of(topics));
  colour = preferred(colour, [](const ImageTopic& topic) { return topic.kind == ImageKind::kColour; });
  colour = preferred(colour, [](const ImageTopic& topic) { return !is_called_depth(topic.topic.name); });
  std::size_t common = 0;
  for (const ImageTopic& topic : colour) common = std::max(common, common_parts(topic.topic.name, depth));
  colour = preferred(colour, [&](const ImageTopic& topic) { return common_parts(topic.topic.name, depth) == common; });
  return best_of_one_camera(colour, file, "colour");
}

ChosenTopic choose_info(const BagFile& file, const std::string& wanted, const ChosenTopics& images) {
  const std::vector<ChosenTopic> infos = topics_of(file, {kCameraInfoType});
  const auto find = [&](const std::string& name) {
    const auto found =
        std::find_if(infos.begin(), infos.end(), [&](const ChosenTopic& info) { return info.name == name; });
    return found == infos.end() ? ChosenTopic{} : *found;
  };
  if (!wanted.empty()) {
    ChosenTopic info = find(wanted);
    require(!info.name.empty(), "{}: no topic {} of type {}, expected one", file.name(), printable(wanted),
            kCameraInfoType);
    return info;
  }
  for (const std::string& image : {images.colour.name, images.depth.name}) {
    const std::string folder = namespace_of(uncompressed(image));
    // RealSense's SDK has SENSOR/image/data and SENSOR/info/camera_info.
    for (const std::string& name : {folder + "/camera_info", namespace_of(folder) + "/info/camera_info"})
      if (ChosenTopic info = find(name); !info.name.empty()) return info;
  }
  return {};
}

}  // namespace

bool is_rectified(const std::string& topic) {
  const std::vector<std::string> parts = parts_of(uncompressed(topic));
  return !parts.empty() && has(parts.back(), "rect");
}

bool is_registered(const ChosenTopics& topics) {
  return topics.depth.frame_id == topics.colour.frame_id || is_called_registered(topics.depth.name);
}

ChosenTopics choose_topics(BagFile& file, const WantedTopics& wanted) {
  const ImageTopics images = image_topics_of(file);
  ChosenTopics topics;
  topics.depth = choose_depth(images, wanted.depth, file.name());
  topics.colour = choose_colour(images, wanted.colour, file.name(), topics.depth.name);
  topics.info = choose_info(file, wanted.info, topics);
  return topics;
}

}  // namespace houghstream::ros_bag
