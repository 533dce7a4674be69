"""Faults and long runs of the stream (tools/soak)."""
