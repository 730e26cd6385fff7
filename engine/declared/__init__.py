"""The keys of scene files, a module for each part of a scene."""
