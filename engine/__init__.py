"""What every system stands on: world, phases, plugins, scene files, terrain files and GL."""
