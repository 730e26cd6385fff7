"""Measurements: how long a frame takes, and how true a picture is."""
