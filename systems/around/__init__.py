"""State kept for each viewer: its patches, their receivers and its appearance; and kernels that all systems share."""
