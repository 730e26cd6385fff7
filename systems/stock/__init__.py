"""Patch models: grown, and kept on disk."""
