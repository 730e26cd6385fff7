"""Reading scene files: YAML with positions, problems with carets."""
