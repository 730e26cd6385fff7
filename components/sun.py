"""The light of sun and sky, for what a game draws itself."""

from dataclasses import dataclass

from .immutable import immutable


@immutable
@dataclass(frozen=True, slots=True)
class Sun:
    """The light on a prairie: linear radiance, before the tone curve and after exposure."""

    direction: tuple[float, float, float]
    """Unit vector to the sun (x, y, z); it points down once the sun has set."""

    colour: tuple[float, float, float]
    """Radiance of a white, matt surface that faces the sun without clouds (red, green, blue); 0 once it has set."""

    sky: tuple[float, float, float]
    """Radiance of a white, matt surface that faces up, lit by the whole sky without the sun."""

    candela: float
    """Radiance of a white, matt surface that faces a lamp of 1 cd at 1 m [1/cd].

    A `Lamp` lights a game's own things with its candela times this, over the square of the distance."""
