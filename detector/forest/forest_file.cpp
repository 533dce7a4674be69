#include "detector/forest/forest_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

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
static_assert(sizeof(TreeNode) == 16 && sizeof(LeafClass) == 16 && sizeof(LeafVote) == 16 && sizeof(LeafView) == 8);

struct Writer : ArchiveWriter {
  using ArchiveWriter::operator();
  void operator()(const std::vector<ObjectClass>& classes) {
    (*this)(std::uint64_t{classes.size()});
    for (const ObjectClass& c : classes) archive_class(*this, c);
  }
};

struct Reader : ArchiveReader {
  using ArchiveReader::operator();
  void operator()(std::vector<ObjectClass>& classes) {
    constexpr std::size_t kMin = 4 + 8 + 2 * 4;  // id, the name's length, radius and mass
    classes.resize(count(kMin));
    for (ObjectClass& c : classes) archive_class(*this, c);
  }
};

std::uint32_t checksum(const std::string& bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
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
  for (const LeafClass& entry : forest.leaf_classes) {
    const bool good = entry.class_index < forest.classes.size() &&
                      entry.first_vote + std::uint64_t{entry.vote_count} <= forest.votes.size() &&
                      entry.first_view + std::uint64_t{entry.view_count} <= forest.leaf_views.size() &&
                      entry.probability >= 0.0F && entry.probability <= 1.0F;
    require(good, "{}: a leaf points outside the forest's lists", source);
  }
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

/// Numbers that are none become any integer later.
void check_numbers(const Forest& forest, const std::string& source) {
  constexpr float kFar = 100.0F;  // metres
  for (const LeafVote& vote : forest.votes) {
    require(vote.offset.array().abs().maxCoeff() < kFar && vote.offset.allFinite() && is_fraction(vote.weight),
            "{}: a vote of weight {}, expected metres and 0 to 1", source, vote.weight);
  }
  for (const LeafView& view : forest.leaf_views)
    require(is_fraction(view.weight), "{}: a view of weight {}, expected 0 to 1", source, view.weight);
  for (const float weight : forest.leaf_weights)
    require(is_fraction(weight), "{}: a leaf of weight {}, expected 0 to 1", source, weight);
  for (const ViewTemplate& view : forest.views) {
    const bool has_box =
        std::all_of(view.box.begin(), view.box.end(), [](float side) { return std::abs(side) < kFar; });
    require(has_box && std::abs(view.R_ray_object.norm() - 1.0F) < 0.01F && view.class_index < forest.classes.size(),
            "{}: a view of class {} with a rotation of length {}, expected one of {} and 1", source, view.class_index,
            view.R_ray_object.norm(), forest.classes.size());
    for (const OutlineCells& across : view.appearance.outline) {
      const int last = std::max({across.inside.row, across.inside.column, across.beyond.row, across.beyond.column});
      require(last < TemplateGrid::kSide, "{}: a view's outline at cell {}, expected less than {}", source, last,
              TemplateGrid::kSide);
    }
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
  header(checksum(payload.bytes));
  AtomicFile whole(file);
  std::ofstream out(whole.partial(), std::ios::binary);
  out << kName << kForestFileVersion << '\n' << header.bytes << payload.bytes;
  out.close();
  require(out.good(), "{}: cannot be written", file.string());
  whole.commit();
}

/// Reads the rest at once, since a forest of many objects has hundreds of megabytes.
static std::string rest_of(std::ifstream& in) {
  const std::istream::pos_type begin = in.tellg();
  const std::istream::pos_type end = in.seekg(0, std::ios::end).tellg();
  if (!in.good() || end < begin) return {};  // cut within what goes before
  std::string rest(static_cast<std::size_t>(end - begin), '\0');
  in.seekg(begin).read(rest.data(), end - begin);
  rest.resize(static_cast<std::size_t>(in.gcount()));
  return rest;
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
  require(version == std::to_string(kForestFileVersion), "{}: forest file of version '{}', expected {}: retrain it",
          source, version, kForestFileVersion);

  std::uint64_t size = 0;
  std::uint32_t crc = 0;
  in.read(reinterpret_cast<char*>(&size), sizeof size);
  in.read(reinterpret_cast<char*>(&crc), sizeof crc);
  const std::string payload = rest_of(in);
  require(payload.size() == size, "{}: payload of {} bytes, expected {}: the file is truncated or damaged", source,
          payload.size(), size);
  require(checksum(payload) == crc, "{}: checksum {:08x}, expected {:08x}: the file is damaged", source,
          checksum(payload), crc);

  Forest forest;
  Reader reader{{payload, source + ": forest payload"}};
  archive_members(reader, forest);
  require(reader.bytes.empty(), "{}: {} bytes left over after the forest", source, reader.bytes.size());
  check_head(forest, source);
  check_indices(forest, source);
  check_leaves(forest, source);
  check_numbers(forest, source);
  return forest;
}

}  // namespace houghstream
