"""The land as shaders know it: heights, densities, postures, and what kinds of grass are like."""
