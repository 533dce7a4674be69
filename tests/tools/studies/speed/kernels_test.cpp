#include "tools/studies/speed/kernels.hpp"

#include <benchmark/benchmark.h>
#include <gtest/gtest.h>

#include "detector/training/forest_trainer.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

/// Records the names of the benchmarks that ran.
class Names : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      EXPECT_FALSE(run.error_occurred) << run.error_message;
      EXPECT_GT(run.iterations, 0) << run.benchmark_name();
      names.push_back(run.benchmark_name());
    }
  }
  std::vector<std::string> names;
};

TEST(Kernels, EachOneRuns) {
  const Forest forest = training::train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  RgbdFrame frame = toy::background(5);
  toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  DetectionSettings settings;
  settings.threads = 1;
  const ForestIndex index(forest);
  register_kernels(frame, index, settings);
  std::string program = "kernels_test";
  std::string briefly = "--benchmark_min_time=0.0001";
  char* arguments[] = {program.data(), briefly.data(), nullptr};
  int count = 2;
  benchmark::Initialize(&count, arguments);
  Names ran;
  benchmark::RunSpecifiedBenchmarks(&ran);
  const std::vector<std::string> expected = {
      "jpeg", "unzip", "working_frame", "features", "resize_features_leaves", "votes", "hypotheses"};
  EXPECT_EQ(ran.names, expected);
}

}  // namespace
}  // namespace houghstream
