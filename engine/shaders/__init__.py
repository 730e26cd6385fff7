"""Shader sources."""
