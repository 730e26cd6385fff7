"""The land in shaders: textures of heights, densities and postures, and values of kinds of grass."""
