"""tools/bench: time, streams, growth and poses, from nothing to a report."""
