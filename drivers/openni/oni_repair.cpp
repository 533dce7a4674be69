#include "drivers/openni/oni_repair.hpp"

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "drivers/openni/oni_records.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream::openni {
namespace {

/// Locates an image in the file.
struct ImagePlace {
  std::uint64_t time = 0;
  std::uint64_t at = 0;  // position of its record
};

struct CutStream {
  std::uint64_t added_at = 0;    // record that adds it
  std::uint64_t fields_end = 0;  // end of that record's fields
  std::vector<ImagePlace> images;
};

struct CutRecording {
  std::map<std::uint32_t, CutStream> streams;  // streams by number
  std::uint64_t end = kOniFileHeader;          // behind the last whole record that precedes the recorder's own ending
};

/// Returns nothing where no whole record of the recording follows.
std::optional<OniRecordHeader> next_record(OniFile& oni, std::uint64_t at) {
  if (at >= oni.size()) return std::nullopt;
  try {
    const OniRecordHeader record = oni.record(at);
    for (const OniRecordType type : {OniRecordType::kEnd, OniRecordType::kNodeRemoved, OniRecordType::kSeekTable})
      if (record.is(type)) return std::nullopt;
    const std::uint64_t minimum = record.is(OniRecordType::kNodeAdded) ? kOniImages : sizeof(std::uint64_t);
    const bool has_fields = record.is(OniRecordType::kNodeAdded) || record.is(OniRecordType::kNewData);
    if (has_fields && record.fields < kOniRecordHeader + minimum) return std::nullopt;
    return record;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

CutRecording read_cut_recording(OniFile& oni) {
  CutRecording cut;
  while (const std::optional<OniRecordHeader> record = next_record(oni, cut.end)) {
    if (record->is(OniRecordType::kNodeAdded)) {
      cut.streams[record->node].added_at = cut.end;
      cut.streams[record->node].fields_end = cut.end + record->fields;
    }
    if (record->is(OniRecordType::kNewData)) {
      const auto stream = cut.streams.find(record->node);
      if (stream == cut.streams.end()) break;
      stream->second.images.push_back({oni.read<std::uint64_t>(cut.end + kOniRecordHeader), cut.end});
    }
    cut.end += record->fields + record->payload;
  }
  return cut;
}

/// Appends the records with which OpenNI2's recorder ends a file.
class OniEnding {
 public:
  OniEnding(OniFile& oni, std::uint64_t at) : oni_(oni), at_(at) {}

  void end_stream(std::uint32_t node, const CutStream& stream) {
    begin_record(OniRecordType::kNodeRemoved, node, 0, stream.added_at);
    const std::uint64_t table = at_;
    begin_record(OniRecordType::kSeekTable, node, kOniSeekEntry * (stream.images.size() + 1), 0);
    append_entry({});  // the first entry belongs to no image
    for (const ImagePlace& image : stream.images) append_entry(image);
    oni_.write(stream.fields_end - kOniImages, static_cast<std::uint32_t>(stream.images.size()));
    const std::uint64_t last = stream.images.empty() ? 0 : stream.images.back().time;
    oni_.write(stream.fields_end - kOniRangeEnd, std::array<std::uint64_t, 3>{0, last, table});
  }

  void end_file() { begin_record(OniRecordType::kEnd, 0, 0, 0); }

 private:
  template <typename T>
  void append(const T& value) {
    oni_.write(at_, value);
    at_ += sizeof(value);
  }

  void begin_record(OniRecordType type, std::uint32_t node, std::uint64_t payload, std::uint64_t undo) {
    append(std::array<std::uint32_t, 5>{kOniMagic, static_cast<std::uint32_t>(type), node,
                                        static_cast<std::uint32_t>(kOniRecordHeader),
                                        static_cast<std::uint32_t>(payload)});
    append(undo);
  }

  void append_entry(const ImagePlace& image) {
    append(image.time);
    append(std::uint32_t{0});  // the configuration, which our recordings do not change
    append(image.at);
  }

  OniFile& oni_;
  std::uint64_t at_;
};

}  // namespace

std::size_t repair_oni(const std::filesystem::path& file) {
  OniFile oni(file, std::ios::in | std::ios::out);
  const CutRecording cut = read_cut_recording(oni);
  std::size_t images = 0;
  for (const auto& [node, stream] : cut.streams) images += stream.images.size();
  require(images > 0, "{}: no whole image in it, expected a recording of OpenNI2's", file.string());
  std::error_code error;
  std::filesystem::resize_file(file, cut.end, error);
  require(!error, "{}: cannot be written: {}", file.string(), error.message());
  OniEnding ending(oni, cut.end);
  for (const auto& [node, stream] : cut.streams) ending.end_stream(node, stream);
  ending.end_file();
  oni.write(kOniFileHeader - sizeof(std::uint32_t), cut.streams.rbegin()->first);
  oni.flush();
  return images;
}

std::size_t copy_repaired_oni(const std::filesystem::path& from, const std::filesystem::path& to) {
  require_regular_file(from, "a recording of OpenNI2's");
  require_other_file(to, from);
  AtomicFile whole(to);
  std::error_code error;
  std::filesystem::copy_file(from, whole.partial(), std::filesystem::copy_options::overwrite_existing, error);
  require(!error, "{}: cannot be written: {}", to.string(), error.message());
  const std::size_t images = repair_oni(whole.partial());
  whole.commit();
  return images;
}

}  // namespace houghstream::openni
