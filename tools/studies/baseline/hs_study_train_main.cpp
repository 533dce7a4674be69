#include "detector/baseline/use_baseline.hpp"
#include "tools/train/train_main.hpp"

int main(int argc, char** argv) {
  houghstream::baseline::use_baseline();
  return houghstream::train_main(argc, argv, "hs-study-train");
}
