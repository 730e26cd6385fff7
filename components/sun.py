"""The sun and the sky as they shine, for what a game draws itself."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Sun:
    """What lights a prairie: linear radiance, before the tone curve, as bright as the picture is exposed."""

    direction: tuple[float, float, float]
    """To the sun, unit length (x, y, z); it points down once the sun has set."""

    colour: tuple[float, float, float]
    """Radiance of a white, dull face that is square to the sun (red, green, blue), past no cloud: 0 once it has set."""

    sky: tuple[float, float, float]
    """Radiance of a white, dull face that looks up, by the whole sky without the sun."""

    candela: float
    """Radiance of a white, dull face that is square to the light of a lamp of 1 cd and 1 m away [1/cd].

    A `Lamp` gives a game's own things its candela times that, over the square of the distance."""
