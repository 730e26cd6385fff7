"""3D: every blade a ribbon."""
