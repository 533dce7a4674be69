"""The measurements of Houghstream: the demo, the benchmarks, the comparison with the paper, and what they share."""
