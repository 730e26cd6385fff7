"""The user interfaces: command line, window, pictures, films and benchmarks."""
