"""Drawing: sky, ground, carpet, strips and blades, back to front."""
