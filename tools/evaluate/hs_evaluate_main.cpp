#include "tools/evaluate/evaluate_main.hpp"

int main(int argc, char** argv) {
  return houghstream::evaluate_main(argc, argv, "hs-evaluate");
}
