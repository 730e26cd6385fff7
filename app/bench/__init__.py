"""Benchmarks: frame times, fidelity of pictures, and visibility of changes."""
