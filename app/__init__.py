"""The doors people come in by: command line, window, pictures, films and benchmarks."""
