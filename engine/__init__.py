"""The base of all systems: world, schedule, plugins, scene files, terrain files and GL."""
