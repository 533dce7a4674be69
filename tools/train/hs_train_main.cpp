#include "tools/train/train_main.hpp"

int main(int argc, char** argv) {
  return houghstream::train_main(argc, argv);
}
