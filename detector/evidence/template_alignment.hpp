#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "detector/evidence/template_matching.hpp"

namespace houghstream {

/// Returns how well a template matches the frame, a weighted sum; larger is better.
float match_quality(const TemplateMatch& fit);

/// A template at a place in the frame, and how it matches there.
struct PlacedTemplate {
  std::uint32_t view = 0;  ///< index into Forest::views
  Eigen::Vector3f centre_camera = Eigen::Vector3f::Zero();
  TemplateMatch fit;
};

/// Returns whether `a` matches the frame better where it is than `b` does.
inline bool matches_better(const PlacedTemplate& a, const PlacedTemplate& b) {
  return match_quality(a.fit) > match_quality(b.fit);
}

/// Keeps the kMax best matches of those added, best first; equal ones keep their order. It does not allocate, since a
/// frame makes many.
template <std::size_t kMax>
class BestTemplates {
 public:
  void add(const PlacedTemplate& placed) {
    if (count_ == kMax && !matches_better(placed, templates_[kMax - 1])) return;
    if (count_ < kMax) ++count_;
    std::size_t place = count_ - 1;
    for (; place > 0 && matches_better(placed, templates_[place - 1]); --place)
      templates_[place] = templates_[place - 1];
    templates_[place] = placed;
  }

  std::size_t size() const { return count_; }
  const PlacedTemplate& front() const { return templates_.front(); }
  const PlacedTemplate* begin() const { return templates_.data(); }
  const PlacedTemplate* end() const { return templates_.data() + count_; }

 private:
  std::array<PlacedTemplate, kMax> templates_;
  std::size_t count_ = 0;
};

/// Moves the template sideways, by cells or parts of them and at most a few times, to where it matches best: votes meet
/// within a few centimetres only. The result matches at least as well.
PlacedTemplate align_template(const std::vector<ViewTemplate>& views, PlacedTemplate placed, const LabFrame& frame,
                              float step_cells = 1.0F);

/// Returns the template that matches best where it is; ties go to the first. `compared` is not empty.
const PlacedTemplate& best_match(const std::vector<PlacedTemplate>& compared);

/// Sorts the templates by how they match where they are, best first, aligns the first few, and returns the one that
/// then matches best. `compared` is not empty.
PlacedTemplate align_best_templates(const std::vector<ViewTemplate>& views, const LabFrame& frame,
                                    std::vector<PlacedTemplate>& compared);

/// Returns how much better the template matches where it is as that of a smaller or of a larger object, whichever
/// matches better; mostly below 0 for an object of the right size.
float alternative_scale_gain(const ViewTemplate& view, const PlacedTemplate& placed, const LabFrame& frame);

}  // namespace houghstream
