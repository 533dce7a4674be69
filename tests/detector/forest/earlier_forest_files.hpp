#pragma once

#include <libdeflate.h>

#include <string>

#include "detector/forest/forest.hpp"
#include "pipeline/base/archive.hpp"

namespace houghstream {

inline std::string forest_file_of(const std::string& version, const std::string& payload) {
  ArchiveWriter header;
  header(std::uint64_t{payload.size()});
  header(std::uint32_t{libdeflate_crc32(0, payload.data(), payload.size())});
  return "HOUGHSTREAM FOREST " + version + '\n' + header.bytes + payload;
}

/// Writes what versions 16 and 17 hold alike before their views.
inline void write_forest_head(ArchiveWriter& payload, const Forest& forest) {
  payload(forest.profile);
  payload(forest.features);
  payload(forest.patch);
  payload(forest.scoring);
  payload(forest.seed);
  payload(std::uint64_t{forest.classes.size()});
  for (const ObjectClass& object : forest.classes) {
    payload(object.class_id);
    payload(object.name);
    payload(object.radius);
    payload(object.nominal_vote_mass);
    for (const auto term : kScoreTermList) payload(object.score_model.weights.*term);
  }
}

/// Returns a forest as files of version 17 hold it: lists as they lie in memory.
inline std::string forest_file_of_version_17(const Forest& forest) {
  ArchiveWriter payload;
  write_forest_head(payload, forest);
  payload(forest.views);
  payload(forest.roots);
  payload(forest.nodes);
  payload(forest.leaves);
  payload(forest.leaf_weights);
  payload(forest.leaf_classes);
  payload(forest.votes);
  payload(forest.leaf_views);
  return forest_file_of("17", payload.bytes);
}

inline void write_view_of_version_16(ArchiveWriter& payload, const ViewTemplate& view) {
  payload(view.class_index);
  payload(view.R_ray_object);
  payload(view.box);
  const auto for_each_cell = [](const auto& visit) {
    for (int row = 0; row < TemplateGrid::kSide; ++row) {
      for (int column = 0; column < TemplateGrid::kSide; ++column) visit(row, column);
    }
  };
  const TemplateGrid& grid = view.appearance;
  for_each_cell([&](int row, int column) { payload(grid.depth_mm(row, column)); });
  for_each_cell([&](int row, int column) {
    const auto cell = static_cast<std::size_t>(row * TemplateGrid::kSide + column);
    payload(row < TemplateGrid::kRimRows ? grid.beside[cell] : TemplateGrid::kNoObject);
  });
  for_each_cell([&](int row, int column) {
    const bool is_in_box = TemplateGrid::is_in_box(row) && TemplateGrid::is_in_box(column);
    payload(is_in_box ? grid.lab[TemplateGrid::colour_index(row, column)] : std::array<std::uint8_t, 3>{});
  });
  payload(find_outline(grid).crossings);
}

/// Returns a forest as files of version 16 hold it: all cells of templates, votes and views of leaves as floating-point
/// numbers.
inline std::string forest_file_of_version_16(const Forest& forest) {
  ArchiveWriter payload;
  write_forest_head(payload, forest);
  payload(std::uint64_t{forest.views.size()});
  for (const ViewTemplate& view : forest.views) write_view_of_version_16(payload, view);
  payload(forest.roots);
  payload(forest.nodes);
  payload(forest.leaves);
  payload(forest.leaf_weights);
  payload(std::uint64_t{forest.leaf_classes.size()});
  LeafStart start;
  for (const LeafClass& entry : forest.leaf_classes) {
    payload(start);
    payload(entry);
    start.pass(entry);
  }
  payload(std::uint64_t{forest.votes.size()});
  for (const LeafVote& vote : forest.votes) {
    const Eigen::Vector3f offset = vote.offset();
    for (int i = 0; i < 3; ++i) payload(offset[i]);
    payload(vote.weight.value());
  }
  payload(std::uint64_t{forest.leaf_views.size()});
  for (const LeafView& view : forest.leaf_views) {
    payload(std::uint32_t{view.view});
    payload(view.weight.value());
  }
  return forest_file_of("16", payload.bytes);
}

}  // namespace houghstream
