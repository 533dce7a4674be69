#include "detector/baseline/use_baseline.hpp"
#include "tools/evaluate/evaluate_main.hpp"

int main(int argc, char** argv) {
  houghstream::baseline::use_baseline();
  return houghstream::evaluate_main(argc, argv, "hs-study-evaluate");
}
