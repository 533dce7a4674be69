#include "detector/forest/forest_file.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>
#include <vector>

#include "detector/features/feature_families.hpp"
#include "pipeline/base/archive.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/zstd_bytes.hpp"

namespace houghstream {
namespace {

constexpr char kName[] = "HOUGHSTREAM FOREST ";

template <typename Archive, typename ClassType>
void archive_class(Archive& archive, ClassType& object) {
  archive(object.class_id);
  archive(object.name);
  archive(object.radius);
  archive(object.nominal_vote_mass);
  for (const auto term : kScoreTermList) archive(object.score_model.weights.*term);
}

/// Visits all members for writing and reading alike, so that the two cannot drift apart; the one above does so for
/// classes.
template <typename Archive, typename ForestType>
void archive_members(Archive& archive, ForestType& forest) {
  archive(forest.profile);
  archive(forest.features);
  archive(forest.patch);
  archive(forest.scoring);
  archive(forest.seed);
  archive(forest.classes);
  archive(forest.views);
  archive(forest.roots);
  archive(forest.nodes);
  archive(forest.leaves);
  archive(forest.leaf_weights);
  archive(forest.leaf_classes);
  archive(forest.votes);
  archive(forest.leaf_views);
}

// Arrays are written as they lie in memory, so no type may have gaps whose bytes nobody set.
static_assert(sizeof(FeatureSettings) == 68 && sizeof(PatchSettings) == 8 &&
              sizeof(ViewTemplate) == 36 + sizeof(TemplateGrid));
static_assert(sizeof(TreeNode) == 16 && sizeof(LeafClass) == 8 && sizeof(LeafVote) == 8 && sizeof(LeafView) == 4);

// Lists are compressed by blocks, which bound what is held twice while a file is read. In a block of numbers the first
// bytes of all items come first, then the second bytes: zstd finds like bytes together, as after Blosc's shuffle.
constexpr std::size_t kBlockBytes = std::size_t{1} << 19U;
constexpr int kCompressionLevel = 3;  // measured on seven objects: 6 saves 2 % more and takes three times as long
constexpr std::size_t kMaxShrinking = 32768;  // chosen: a block of 128 KiB takes zstd four bytes (RFC 8878, 3.1.1.2)

template <typename T>
constexpr std::size_t kBlockItems = kBlockBytes / sizeof(T);

/// Calls visit(in_item, in_planes) for each byte of a block: its places in the items and in the planes.
template <typename T, typename Visit>
void for_each_byte(std::size_t items, const Visit& visit) {
  constexpr bool kIsNumbers = sizeof(T) <= 16;  // larger ones hold arrays of like bytes already
  constexpr std::size_t kPlanes = kIsNumbers ? sizeof(T) : 1;
  for (std::size_t i = 0; i < items * sizeof(T) / kPlanes; ++i) {
    for (std::size_t plane = 0; plane < kPlanes; ++plane) visit(i * kPlanes + plane, plane * items + i);
  }
}

template <typename T>
std::string to_planes(const T* items, std::size_t count) {
  std::string planes(count * sizeof(T), '\0');
  const auto* bytes = reinterpret_cast<const char*>(items);
  for_each_byte<T>(count, [&](std::size_t in_item, std::size_t in_planes) { planes[in_planes] = bytes[in_item]; });
  return planes;
}

template <typename T>
void from_planes(const std::string& planes, T* items, std::size_t count) {
  auto* bytes = reinterpret_cast<char*>(items);
  for_each_byte<T>(count, [&](std::size_t in_item, std::size_t in_planes) { bytes[in_item] = planes[in_planes]; });
}

struct Writer : ArchiveWriter {
  using ArchiveWriter::operator();
  void operator()(const std::vector<ObjectClass>& classes) {
    (*this)(std::uint64_t{classes.size()});
    for (const ObjectClass& c : classes) archive_class(*this, c);
  }
  template <typename T>
  void operator()(const std::vector<T>& values) {
    (*this)(std::uint64_t{values.size()});
    for (std::size_t first = 0; first < values.size(); first += kBlockItems<T>) {
      const std::size_t items = std::min(kBlockItems<T>, values.size() - first);
      (*this)(compress_zstd(to_planes(values.data() + first, items), kCompressionLevel));
    }
  }
};

/// Reads forest files of version 17, whose lists are not compressed.
struct ReaderOfVersion17 : ArchiveReader<StreamBytes> {
  using ArchiveReader<StreamBytes>::operator();
  void operator()(std::vector<ObjectClass>& classes) {
    constexpr std::size_t kMin = 4 + 8 + 2 * 4;  // id, the name's length, radius and mass
    classes.resize(count(kMin));
    for (ObjectClass& c : classes) archive_class(*this, c);
  }
};

struct Reader : ReaderOfVersion17 {
  using ReaderOfVersion17::operator();
  template <typename T>
  void operator()(std::vector<T>& values) {
    std::uint64_t items = 0;
    take(&items, sizeof items);
    require(items <= bytes.size() * kMaxShrinking / sizeof(T), "{}: a list of {} items in {} bytes", source, items,
            bytes.size());
    values.resize(static_cast<std::size_t>(items));
    std::string block;
    std::string planes;
    for (std::size_t first = 0; first < values.size(); first += kBlockItems<T>) {
      const std::size_t in_block = std::min(kBlockItems<T>, values.size() - first);
      (*this)(block);
      planes.resize(in_block * sizeof(T));
      decompress_zstd(block, planes.data(), planes.size(), source);
      from_planes(planes, values.data() + first, in_block);
    }
  }
};

/// Reads what forest files of version 16 hold in another form: templates with all cells, and votes and views of leaves
/// as floating-point numbers.
struct ReaderOfVersion16 : ReaderOfVersion17 {
  using ReaderOfVersion17::operator();
  struct Template {
    std::uint32_t class_index;
    std::array<float, 4> rotation;
    std::array<float, 4> box;
    std::array<std::int16_t, TemplateGrid::kSide * TemplateGrid::kSide> mm;
    std::array<std::int16_t, TemplateGrid::kSide * TemplateGrid::kSide> beside;
    std::array<std::array<std::uint8_t, 3>, TemplateGrid::kSide * TemplateGrid::kSide> lab;
    std::array<OutlineCells, 4 * TemplateGrid::kBoxSide> outline;
  };
  struct Entry {
    std::uint32_t first_vote;
    std::uint32_t first_view;
    LeafClass entry;
  };
  struct Vote {
    Eigen::Vector3f offset;
    float weight;
  };
  struct View {
    std::uint32_t view;
    float weight;
  };
  static_assert(sizeof(Template) == 4548 && sizeof(Entry) == 16 && sizeof(Vote) == 16 && sizeof(View) == 8);

  /// Reads a list of `Old`, and makes of each what convert() returns.
  template <typename Old, typename New, typename Convert>
  void read_each(std::vector<New>& values, const Convert& convert) {
    std::vector<Old> old;
    (*this)(old);
    values.clear();
    values.reserve(old.size());
    for (const Old& value : old) values.push_back(convert(value));
  }
  void operator()(std::vector<ViewTemplate>& views);
  void operator()(std::vector<LeafClass>& entries) {
    LeafStart start;
    read_each<Entry>(entries, [&](const Entry& old) {
      require(old.first_vote == start.vote && old.first_view == start.view,
              "{}: an entry of a leaf begins at vote {}, expected {}, behind the entry before it", source,
              old.first_vote, start.vote);
      start.pass(old.entry);
      return old.entry;
    });
  }
  void operator()(std::vector<LeafVote>& votes) {
    read_each<Vote>(votes, [&](const Vote& old) {
      require(old.offset.allFinite() && std::isfinite(old.weight), "{}: a vote of weight {}, expected a number", source,
              old.weight);
      return LeafVote(old.offset, old.weight);
    });
  }
  void operator()(std::vector<LeafView>& views) {
    read_each<View>(views, [&](const View& old) {
      require(old.view < LeafView::kMaxViews && std::isfinite(old.weight), "{}: a leaf remembers view {}, expected {}",
              source, old.view, "one of at most 65536");
      return LeafView{static_cast<std::uint16_t>(old.view), Share(old.weight)};
    });
  }
};

void ReaderOfVersion16::operator()(std::vector<ViewTemplate>& views) {
  constexpr std::size_t kSide = TemplateGrid::kSide;
  constexpr std::size_t kRim = TemplateGrid::kRim;
  read_each<Template>(views, [](const Template& old) {
    ViewTemplate view;
    view.class_index = old.class_index;
    view.R_ray_object.coeffs() = Eigen::Map<const Eigen::Vector4f>(old.rotation.data());
    view.box = old.box;
    TemplateGrid& grid = view.appearance;
    std::copy_n(old.mm.begin() + kRim * kSide, grid.mm.size(), grid.mm.begin());
    std::copy_n(old.beside.begin(), grid.beside.size(), grid.beside.begin());
    for (std::size_t row = 0; row < TemplateGrid::kBoxSide; ++row) {
      std::copy_n(old.lab.begin() + static_cast<std::ptrdiff_t>((row + kRim) * kSide + kRim), TemplateGrid::kBoxSide,
                  grid.lab.begin() + static_cast<std::ptrdiff_t>(row * TemplateGrid::kBoxSide));
    }
    return view;
  });
}

template <typename PayloadReader>
void read_members(PayloadReader reader, Forest& forest) {
  archive_members(reader, forest);
  require(reader.bytes.empty(), "{}: {} bytes left over after the forest", reader.source, reader.bytes.size());
}

/// Returns the checksum of the rest of the file, and leaves it where it was.
std::uint32_t checksum_of_rest(std::ifstream& in) {
  const std::istream::pos_type begin = in.tellg();
  std::vector<char> part(1U << 20U);
  std::uint32_t sum = 0;
  while (in.read(part.data(), static_cast<std::streamsize>(part.size())), in.gcount() > 0)
    sum = libdeflate_crc32(sum, part.data(), static_cast<std::size_t>(in.gcount()));
  in.clear();
  in.seekg(begin);
  return sum;
}

std::uint64_t size_of_rest(std::ifstream& in) {
  const std::istream::pos_type begin = in.tellg();
  const std::istream::pos_type end = in.seekg(0, std::ios::end).tellg();
  in.seekg(begin);
  return in.good() && end > begin ? static_cast<std::uint64_t>(end - begin) : 0;
}

/// Checks that the content makes sense. The checksum only says that the file is what was written.
void check_indices(const Forest& forest, const std::string& source) {
  const auto nodes = static_cast<std::int64_t>(forest.nodes.size());
  const auto leaves = static_cast<std::int64_t>(forest.leaves.size()) - 1;
  const int planes = FeatureLayout(forest.features).planes();
  const auto check_child = [&](std::int64_t child, std::int64_t parent) {
    const bool good = child >= 0 ? child > parent && child < nodes : -1 - child < leaves;
    require(good, "{}: a tree points to node {}, expected a later one of {} nodes or one of {} leaves", source, child,
            nodes, leaves);
  };
  require(leaves >= 1 && forest.leaves.back() == forest.leaf_classes.size(), "{}: {} leaves, expected at least one",
          source, leaves);
  require(static_cast<std::int64_t>(forest.leaf_weights.size()) == leaves, "{}: {} leaf weights, expected {}", source,
          forest.leaf_weights.size(), leaves);
  for (const std::int32_t root : forest.roots) check_child(root, -1);
  for (std::int64_t n = 0; n < nodes; ++n) {
    const TreeNode& node = forest.nodes[static_cast<std::size_t>(n)];
    check_child(node.left, n);
    check_child(node.right, n);
    const int reach = forest.patch.radius;
    const PixelTest& t = node.test;
    const bool inside = std::max({std::abs(t.dx1), std::abs(t.dy1), std::abs(t.dx2), std::abs(t.dy2)}) <= reach;
    require(
        inside && t.plane < planes &&
            (t.kind == PixelTest::kDifference || t.kind == PixelTest::kWrapping || t.kind == PixelTest::kSinglePixel),
        "{}: node {} tests plane {}, expected one of {} planes within {} steps", source, n, t.plane, planes, reach);
  }
}

void check_leaves(const Forest& forest, const std::string& source) {
  std::uint64_t votes = 0;
  std::uint64_t views = 0;
  for (const LeafClass& entry : forest.leaf_classes) {
    votes += entry.vote_count;
    views += entry.view_count;
    require(entry.class_index < forest.classes.size() && entry.probability >= 0.0F && entry.probability <= 1.0F,
            "{}: a leaf with class {} of {} and a probability of {}, expected 0 to 1", source, entry.class_index,
            forest.classes.size(), entry.probability);
  }
  require(votes == forest.votes.size() && views == forest.leaf_views.size(),
          "{}: leaves of {} votes and {} views, expected {} and {}", source, votes, views, forest.votes.size(),
          forest.leaf_views.size());
  for (std::size_t l = 1; l < forest.leaves.size(); ++l) {
    require(forest.leaves[l - 1] <= forest.leaves[l], "{}: leaf {} ends before it begins", source, l - 1);
  }
  std::vector<std::size_t> last_leaf(forest.classes.size(), 0);  // last leaf that knew a class, counted from 1
  for (std::size_t l = 1; l < forest.leaves.size(); ++l) {       // within the list: the last one ends where it does
    for (std::uint32_t e = forest.leaves[l - 1]; e < forest.leaves[l]; ++e) {
      const std::uint32_t known = forest.leaf_classes[e].class_index;
      require(std::exchange(last_leaf[known], l) != l, "{}: leaf {} knows class {} twice", source, l - 1, known);
    }
  }
  for (const LeafView& view : forest.leaf_views) {
    require(view.view < forest.views.size(), "{}: a leaf remembers view {} of {}", source, view.view,
            forest.views.size());
  }
}

bool is_fraction(float value) {
  return value >= 0.0F && value <= 1.001F;
}

/// Returns whether the columns beside the box show nothing of the object.
bool is_within_box(const TemplateGrid& grid) {
  for (int row = TemplateGrid::kRim; row < TemplateGrid::kRim + TemplateGrid::kBoxSide; ++row) {
    for (int i = 0; i < TemplateGrid::kRim; ++i) {
      if (grid.depth_mm(row, i) != TemplateGrid::kNoObject ||
          grid.depth_mm(row, TemplateGrid::kSide - 1 - i) != TemplateGrid::kNoObject)
        return false;
    }
  }
  return true;
}

/// Numbers that are none become any integer later.
void check_numbers(const Forest& forest, const std::string& source) {
  constexpr float kFar = 100.0F;  // metres
  for (const float weight : forest.leaf_weights)
    require(is_fraction(weight), "{}: a leaf of weight {}, expected 0 to 1", source, weight);
  for (const ViewTemplate& view : forest.views) {
    const bool has_box =
        std::all_of(view.box.begin(), view.box.end(), [](float side) { return std::abs(side) < kFar; });
    require(has_box && std::abs(view.R_ray_object.norm() - 1.0F) < 0.01F && view.class_index < forest.classes.size(),
            "{}: a view of class {} with a rotation of length {}, expected one of {} and 1", source, view.class_index,
            view.R_ray_object.norm(), forest.classes.size());
    require(is_within_box(view.appearance), "{}: a view shows its object beside its box", source);
  }
}

void check_head(const Forest& forest, const std::string& source) {
  check_settings(forest.features, source + ": features");
  check_settings(forest.patch, source + ": patch");
  require(forest.scoring == Scoring::kEvidence || forest.scoring == Scoring::kVotes, "{}: scoring {}, expected 0 or 1",
          source, static_cast<std::uint32_t>(forest.scoring));
  require(!forest.classes.empty() && !forest.roots.empty(), "{}: {} classes and {} trees, expected at least one each",
          source, forest.classes.size(), forest.roots.size());
  for (const ObjectClass& c : forest.classes) {
    require(c.radius > 0.0F && c.radius < 10.0F && c.nominal_vote_mass > 0.0F && std::isfinite(c.nominal_vote_mass),
            "{}: class '{}' of radius {} m, expected 0 to 10 m", source, c.name, c.radius);
    for (const auto term : kScoreTermList) {
      const float weight = c.score_model.weights.*term;
      require(std::isfinite(weight), "{}: class '{}' has score weight {}, expected a number", source, c.name, weight);
    }
  }
}

}  // namespace

void save_forest(const Forest& forest, const std::filesystem::path& file) {
  Writer payload;
  archive_members(payload, forest);
  Writer header;
  header(static_cast<std::uint64_t>(payload.bytes.size()));
  header(libdeflate_crc32(0, payload.bytes.data(), payload.bytes.size()));
  AtomicFile whole(file);
  std::ofstream out(whole.partial(), std::ios::binary);
  out << kName << kForestFileVersion << '\n' << header.bytes << payload.bytes;
  out.close();
  require(out.good(), "{}: cannot be written", file.string());
  whole.commit();
}

Forest load_forest(const std::filesystem::path& file) {
  const std::string source = file.string();
  require_regular_file(file, "a forest file");
  std::ifstream in(file, std::ios::binary);
  require(in.good(), "{}: forest file cannot be opened", source);
  std::string line;
  std::getline(in, line);
  require(line.rfind(kName, 0) == 0, "{}: not a forest file, expected it to begin with '{}{}'", source, kName,
          kForestFileVersion);
  const std::string version = line.substr(sizeof kName - 1);
  require(version == "16" || version == "17" || version == std::to_string(kForestFileVersion),
          "{}: forest file of version '{}', expected {}: retrain it", source, version, kForestFileVersion);

  std::uint64_t size = 0;
  std::uint32_t crc = 0;
  in.read(reinterpret_cast<char*>(&size), sizeof size);
  in.read(reinterpret_cast<char*>(&crc), sizeof crc);
  const std::uint64_t bytes = size_of_rest(in);
  require(bytes == size, "{}: payload of {} bytes, expected {}: the file is truncated or damaged", source, bytes, size);
  const std::uint32_t sum = checksum_of_rest(in);
  require(sum == crc, "{}: checksum {:08x}, expected {:08x}: the file is damaged", source, sum, crc);

  Forest forest;
  const ReaderOfVersion17 payload{{{in, bytes}, source + ": forest payload"}};
  if (version == "16") {
    read_members(ReaderOfVersion16{payload}, forest);
  } else if (version == "17") {
    read_members(payload, forest);
  } else {
    read_members(Reader{payload}, forest);
  }
  check_head(forest, source);
  check_indices(forest, source);
  check_leaves(forest, source);
  check_numbers(forest, source);
  return forest;
}

}  // namespace houghstream
