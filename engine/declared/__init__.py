"""What a scene file can declare, part by part."""
