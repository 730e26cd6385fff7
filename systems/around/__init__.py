"""What is kept around each viewer: its patches, their receivers, the ground; and the kernels that all systems share."""
