"""Patch models: grown, kept on disk, and made ready to be stood on the terrain."""
