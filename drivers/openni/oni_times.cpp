#include "drivers/openni/oni_times.hpp"

#include <map>
#include <vector>

#include "drivers/openni/oni_records.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream::openni {
namespace {

/// Returns the positions of the times in a record at `at`.
std::vector<std::uint64_t> times_in(const OniRecordHeader& record, std::uint64_t at) {
  const std::uint64_t payload = at + record.fields;
  switch (static_cast<OniRecordType>(record.type)) {
    case OniRecordType::kNewData: return {at + kOniRecordHeader};
    case OniRecordType::kNodeAdded: return {payload - kOniRangeEnd, payload - kOniRangeEnd + sizeof(std::uint64_t)};
    case OniRecordType::kSeekTable: break;
    default: return {};
  }
  std::vector<std::uint64_t> places;  // the first entry belongs to no image
  for (std::uint64_t entry = kOniSeekEntry; entry + kOniSeekEntry <= record.payload; entry += kOniSeekEntry) {
    places.push_back(payload + entry);
  }
  return places;
}

/// Frames that a stream's header states, and those that are there.
struct StreamContent {
  std::uint32_t stated = 0;             // images
  std::vector<std::uint64_t> times;     // times of its images
  std::vector<std::uint64_t> in_table;  // likewise, of its seek table
};

void note_record(OniFile& oni, const OniRecordHeader& record, std::uint64_t at, StreamContent& stream) {
  const auto type = static_cast<OniRecordType>(record.type);
  const std::uint64_t minimum =
      kOniRecordHeader + (type == OniRecordType::kNodeAdded ? kOniImages : sizeof(std::uint64_t));
  require(record.fields >= minimum || (type != OniRecordType::kNodeAdded && type != OniRecordType::kNewData),
          "{}: a record of {} bytes at byte {}, expected {} or more", oni.name(), record.fields, at, minimum);
  if (type == OniRecordType::kNodeAdded) stream.stated = oni.read<std::uint32_t>(at + record.fields - kOniImages);
  if (type == OniRecordType::kNewData) stream.times.push_back(oni.read<std::uint64_t>(times_in(record, at).front()));
  if (type != OniRecordType::kSeekTable) return;
  for (const std::uint64_t place : times_in(record, at)) stream.in_table.push_back(oni.read<std::uint64_t>(place));
}

}  // namespace

std::size_t check_oni(const std::filesystem::path& file) {
  OniFile oni(file);
  std::map<std::uint32_t, StreamContent> streams;
  std::uint64_t at = kOniFileHeader;
  OniRecordHeader record = oni.record(at);
  for (; static_cast<OniRecordType>(record.type) != OniRecordType::kEnd; record = oni.record(at)) {
    note_record(oni, record, at, streams[record.node]);
    at += record.fields + record.payload;
  }
  std::size_t images = 0;
  for (const auto& [node, stream] : streams) {
    require(stream.times.size() == stream.stated, "{}: stream {} states {} images, {} are there", oni.name(), node,
            stream.stated, stream.times.size());
    require(stream.in_table.empty() || stream.in_table == stream.times,
            "{}: the images of stream {} are not at the times of its seek table", oni.name(), node);
    images += stream.times.size();
  }
  return images;
}

void delay_oni_node(const std::filesystem::path& file, OniNode node, std::int64_t delay_us) {
  require(delay_us >= 0, "{}: a delay of {} us, expected none or more", file.string(), delay_us);
  OniFile oni(file, std::ios::in | std::ios::out);
  std::vector<std::uint64_t> places;
  std::uint64_t at = kOniFileHeader;
  for (OniRecordHeader record = oni.record(at); static_cast<OniRecordType>(record.type) != OniRecordType::kEnd;
       record = oni.record(at)) {
    if (record.node == static_cast<std::uint32_t>(node)) {
      const std::vector<std::uint64_t> found = times_in(record, at);
      places.insert(places.end(), found.begin(), found.end());
    }
    at += record.fields + record.payload;
  }
  for (const std::uint64_t place : places)
    oni.write(place, oni.read<std::uint64_t>(place) + static_cast<std::uint64_t>(delay_us));
  oni.flush();
}

}  // namespace houghstream::openni
