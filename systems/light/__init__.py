"""Light: sun, sky, air and clouds, the terrain's shadows, and materials of grass and ground."""
