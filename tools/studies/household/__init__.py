"""tools/bench household: stores of 4, 7, 20, 40 and 60 objects in the same rendered rooms."""
