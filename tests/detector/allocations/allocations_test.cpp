#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "detector/detector.hpp"
#include "detector/stages.hpp"
#include "detector/training/forest_trainer.hpp"
#include "detector/training/object_removal.hpp"
#include "tests/detector/toy_data.hpp"

// Counts the allocations of the whole process, OpenCV's images and operator new included: glibc lets a program replace
// these functions, and provides the originals under other names. NOLINTBEGIN(bugprone-reserved-identifier,
// readability-identifier-naming): its names
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)

namespace {

constexpr std::size_t kLarge = 16 << 10;  // bytes
// The lists of maxima, hypotheses and candidates, of which the last ones' rotations are handed to the caller, some
// lists of the levels and their planes, and what OpenCV's filters need for themselves: none grows with the image.
constexpr std::size_t kFew = 150;
constexpr int kInARow = 8;  // frames that ask for no more
std::atomic<std::size_t> small_ones{0};
std::atomic<std::size_t> large_ones{0};

void count_allocation(std::size_t size) {
  ++(size < kLarge ? small_ones : large_ones);
}

}  // namespace

extern "C" {
void* malloc(std::size_t size) noexcept {
  count_allocation(size);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  count_allocation(count * size);
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  count_allocation(size);
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  count_allocation(size);
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}
}

namespace houghstream {
namespace {

struct Allocations {
  std::size_t small = 0;
  std::size_t large = 0;
};

/// Returns the allocations of one frame.
Allocations allocations_of(const Detector& detector, const RgbdFrame& frame, DetectorWorkspace& workspace) {
  const Allocations before{small_ones, large_ones};
  const Detections found = detector.detect(frame, workspace);
  EXPECT_FALSE(found.detections.empty());
  return {small_ones - before.small, large_ones - before.large};
}

TEST(Allocations, AreCounted) {
  const Allocations before{small_ones, large_ones};
  const cv::Mat image(256, 256, CV_8UC1);
  const std::vector<int> numbers(10);
  EXPECT_GE(large_ones, before.large + 1);
  EXPECT_GE(small_ones, before.small + 1);
}

/// Looks at frames until as many in a row as are wanted ask for no memory that grows with the image.
void expect_few_allocations(const Detector& detector, const RgbdFrame& frame, std::size_t few) {
  DetectorWorkspace workspace;
  // Which worker gets which items is chance, so that one may meet something for the first time after many frames.
  int in_a_row = 0;
  Allocations last;
  for (int number = 0; number < 200 && in_a_row < kInARow; ++number) {
    last = allocations_of(detector, frame, workspace);
    in_a_row = last.small <= few && last.large == 0 ? in_a_row + 1 : 0;
  }
  EXPECT_EQ(in_a_row, kInARow) << detector.settings().threads << " threads, the last frame: " << last.small
                               << " small ones and " << last.large << " large ones";
}

RgbdFrame frame_with_tiles() {
  RgbdFrame frame = toy::background(5);
  toy::put_tile(0, 90, 120, 0.8, frame);
  toy::put_tile(1, 230, 120, 0.9, frame);
  // The frame has the usual focal length: frames of a coarser camera are enlarged, for which OpenCV allocates memory.
  frame.camera = frame.camera.scaled(2.0);
  cv::resize(frame.colour, frame.colour, cv::Size(), 2.0, 2.0, cv::INTER_NEAREST);
  cv::resize(frame.depth, frame.depth, cv::Size(), 2.0, 2.0, cv::INTER_NEAREST);
  return frame;
}

TEST(Allocations, FramesTakeTheMemoryOfThoseBefore) {
  const Forest forest = training::train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  const RgbdFrame frame = frame_with_tiles();
  for (const int threads : {1, 2}) {
    DetectionSettings settings = toy::quick_profile().detection;
    settings.threads = threads;
    expect_few_allocations(Detector(forest, settings), frame, kFew);
  }
}

/// The second group has one object, the first has two: what one leaves in the workspace serves the other.
TEST(Allocations, GroupsTakeTheMemoryOfOneAnother) {
  const Forest forest = training::train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  Forest other = training::remove_object(forest, "stripes");
  other.classes.front().class_id = 3;
  other.classes.front().name = "circles";
  DetectionSettings settings = toy::quick_profile().detection;
  settings.threads = 2;
  expect_few_allocations(Detector(std::vector<Forest>{forest, other}, settings), frame_with_tiles(), 2 * kFew);
}

}  // namespace
}  // namespace houghstream
