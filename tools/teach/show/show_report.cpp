#include "tools/teach/show/show_report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace houghstream::teach {
namespace {

using reconstruction::LostSpan;
using reconstruction::Motion;
using reconstruction::RegisteredFrame;
using reconstruction::Take;

int lost_frames(const Take& take) {
  int count = 0;
  for (const LostSpan& span : take.lost) count += span.to - span.from + 1;
  return count;
}

std::string span_text(const Take& take, const LostSpan& span) {
  return fmt::format("lost between second {:.1f} and {:.1f}: {}", second_of(take, span.from), second_of(take, span.to),
                     span.why);
}

/// Returns why it was seen from few sides, where that was not for want of frames.
std::string unused_frames(const Take& take) {
  constexpr double kMany = 0.3;
  if (take.blurred + take.badly_exposed <= kMany * static_cast<double>(take.frames.size())) return {};
  return fmt::format("; of {} frames {} were blurred and {} too dark or burnt out, which count for nothing",
                     take.frames.size(), take.blurred, take.badly_exposed);
}

/// Adds the objections to a take.
void assess_take(const Take& take, std::vector<std::string>& reasons) {
  constexpr int kNearlyRound = 300;
  constexpr int kRound = 350;
  constexpr double kMaxLost = 0.15;
  constexpr double kMaxGap_m = 0.03;
  constexpr double kMaxGapAngle = 0.12;
  if (take.motion == Motion::kUnknown)
    reasons.emplace_back(
        "neither the camera nor the object was seen to move, expected a turn about it (a plain round "
        "object that turns by itself looks as if it stood still)");
  if (take.covered_degrees < kNearlyRound)
    reasons.push_back(fmt::format("too short: seen from {} degrees of the turn, expected all 360{}",
                                  take.covered_degrees, unused_frames(take)));
  else if (take.covered_degrees >= kRound && !take.loop_error)
    reasons.emplace_back(
        "it came round, and did not find its beginning again: nothing tells how it turned, or the way was lost");
  if (lost_frames(take) > kMaxLost * static_cast<double>(take.frames.size())) {
    for (const LostSpan& span : take.lost) {
      if (reasons.size() < 8) reasons.push_back(span_text(take, span));
    }
  }
  if (take.loop_error && (take.loop_error->shift_m > kMaxGap_m || take.loop_error->angle_rad > kMaxGapAngle))
    reasons.push_back(fmt::format("the turn missed its beginning by {:.0f} mm and {:.1f} degrees",
                                  1e3 * take.loop_error->shift_m, degrees_of(*take.loop_error)));
}

/// Adds the objections to each of the takes.
void assess_takes(const ShowResult& shown, std::vector<std::string>& reasons) {
  constexpr std::size_t kMinKeyframes = 8;
  for (std::size_t t = 0; t < shown.takes.size(); ++t) {
    std::vector<std::string> of_take;
    if (shown.takes[t].motion != Motion::kTurntable) assess_take(shown.takes[t], of_take);
    if (shown.views[t].size() < kMinKeyframes)
      of_take.push_back(fmt::format("only {} keyframes show it", shown.views[t].size()));
    for (const std::string& reason : of_take) reasons.push_back((t == 0 ? "" : "the second take: ") + reason);
  }
}

const char* what_moved(Motion motion) {
  switch (motion) {
    case Motion::kCamera: return "the camera moved";
    case Motion::kObject: return "the object moved";
    case Motion::kTurntable: return "a turntable moved";
    case Motion::kUnknown: break;
  }
  return "nothing moved";
}

/// Describes the takes in a few lines. Turntable videos are neither tracked nor closed as a loop: their masks place
/// them.
std::string describe_take(const Take& take) {
  if (take.motion == Motion::kTurntable)
    return fmt::format("  {} pictures with masks; {}\n", take.keyframes.size(), what_moved(take.motion));
  std::string text = fmt::format("  {}\n", reconstruction::describe_selection(take.selected));
  text += fmt::format(
      "  {} frames in {:.1f} s, {} tracked, {} keyframes, {} blurred, {} badly exposed; {}; tracked at {:.0f} Hz\n",
      take.frames.size(), second_of(take, static_cast<int>(take.frames.size()) - 1), tracked_frames(take),
      take.keyframes.size(), take.blurred, take.badly_exposed, what_moved(take.motion), take.tracking_hz);
  for (const LostSpan& span : take.lost) text += "  " + span_text(take, span) + "\n";
  text += take.loop_error
              ? fmt::format("  the turn's end missed its beginning by {:.1f} mm and {:.2f} degrees, and was closed\n",
                            1e3 * take.loop_error->shift_m, degrees_of(*take.loop_error))
              : "  the turn was not closed\n";
  return text;
}

}  // namespace

double second_of(const Take& take, int frame) {
  return seconds_between(take.frames.front().id.utime, take.frames[static_cast<std::size_t>(frame)].id.utime);
}

int tracked_frames(const Take& take) {
  return static_cast<int>(std::count_if(take.frames.begin(), take.frames.end(),
                                        [](const RegisteredFrame& frame) { return frame.tracked; }));
}

reconstruction::ViewCoverage seen_by_all(const ShowResult& shown) {
  reconstruction::ViewCoverage coverage{};
  for (const Take& take : shown.takes) {
    for (std::size_t i = 0; i < coverage.size(); ++i) coverage[i] = coverage[i] || take.seen[i];
  }
  return coverage;
}

double degrees_of(const reconstruction::LoopClosureError& loop_error) {
  constexpr double kDegrees = 57.29577951308232;
  return kDegrees * loop_error.angle_rad;
}

double covered_fraction(const std::vector<bool>& seen) {
  return static_cast<double>(std::count(seen.begin(), seen.end(), true)) /
         static_cast<double>(std::max<std::size_t>(1, seen.size()));
}

ModelAssessment assess_model(const ShowResult& shown) {
  constexpr double kMaxDeviation_m = 0.003;
  constexpr double kMinSurface = 0.55;
  constexpr double kMinOverlap = 0.9;
  ModelAssessment assessment;
  assess_takes(shown, assessment.reasons);
  if (shown.deviation_m > kMaxDeviation_m)
    assessment.reasons.push_back(fmt::format("the views disagree by {:.1f} mm, expected less than {:.0f}",
                                             1e3 * shown.deviation_m, 1e3 * kMaxDeviation_m));
  if (shown.silhouette_iou.value_or(1.0) < kMinOverlap)
    assessment.reasons.push_back(
        fmt::format("the model's outline overlaps with the masks by {:.2f}, expected at least {}",
                    *shown.silhouette_iou, kMinOverlap));
  if (shown.seen_surface < kMinSurface)
    assessment.reasons.push_back(fmt::format("only {:.0f} % of its surface was seen", 100.0 * shown.seen_surface));
  if (shown.free_space_violation > reconstruction::kMaxFreeSpaceViolation)
    assessment.reasons.push_back(
        fmt::format("the model is seen through in {:.0f} % of its outline, expected less than {:.0f}: a hand or the "
                    "table was taken for it",
                    100.0 * shown.free_space_violation, 100.0 * reconstruction::kMaxFreeSpaceViolation));
  if (!shown.second_fits)
    assessment.reasons.emplace_back(
        "the second take does not fit the first, or shows a hand or the table as if they were the object, expected the "
        "same object, another side up");
  assessment.good = assessment.reasons.empty();
  return assessment;
}

std::string describe(const ShowResult& shown, const ModelAssessment& assessment) {
  const Take& take = shown.takes.front();
  std::string text = fmt::format("{}: {}\n", shown.name, assessment.good ? "good" : "poor");
  for (const std::string& reason : assessment.reasons) text += "  " + reason + "\n";
  const Eigen::Vector3d front = take.selected.T_camera_stand.inverse().translation();
  text += fmt::format("  {}\n", reconstruction::describe_coverage(seen_by_all(shown), front));
  for (const Take& one : shown.takes) text += describe_take(one);
  text +=
      fmt::format("  {:.0f} mm across, views agree within {:.2f} mm, {:.0f} % of the surface seen; {:.1f} s\n",
                  1e3 * mesh_diameter(shown.mesh), 1e3 * shown.deviation_m, 100.0 * shown.seen_surface, shown.seconds);
  return text;
}

}  // namespace houghstream::teach
