"""The frame block, which all programs share, and the interface of features."""
