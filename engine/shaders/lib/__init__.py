"""Shader parts that several programs include."""
