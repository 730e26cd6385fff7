"""Bundled scenes; a scene's name is its file's stem."""
