"""The vortex street that wind leaves behind a rock (von Karman, 1911), as a wind of tallgrass."""

import numpy as np
from pydantic import Field

from tallgrass import Extent, Grass, PlacedWind, TwinValues


class VortexStreet(PlacedWind):
    """Whirls that leave a rock on either side in turn, drift ahead, grow and fade; the rock is at `position`."""

    twin = "vortex_street.glsl"
    kind: str = "vortex-street"
    """A vortex street behind a rock."""
    rock: float = Field(default=2.0, ge=0.2, le=50.0)
    """Width of the rock [m]."""
    speed: float = Field(default=2.5, ge=0.0, le=40.0)
    """Speed at which the whirls drift [m/s]."""
    strength: float = Field(default=0.8, ge=0.0, le=1.0)
    """Posture index that a young whirl adds on its rim."""

    def rates(self) -> tuple[float]:
        """Return the frequency of whirls [1/s], so that they go on smoothly when a game changes the speed."""
        return (self.speed / (2.5 * self.rock),)

    def extent(self, *, time: float) -> Extent:
        """Return the rectangle of ten whirls; on each side they are five widths of the rock apart."""
        return Extent(-2.5 * self.rock, 2.5 * self.rock, -25.0 * self.rock, 0.0)

    def mask(self, place: np.ndarray, /, *, time: float) -> np.ndarray:
        """Return 1 in the middle, falling to 0 on the sides and ends."""
        across, along = place.T / (2.5 * self.rock)
        return np.asarray(np.clip(2.0 * np.minimum(np.minimum(-along, 10.0 + along), 1.0 - abs(across)), 0.0, 1.0))

    def action(self, place: np.ndarray, /, *, time: float, seed: int, grass: Grass) -> np.ndarray:
        """Return a light wind ahead, and on it what the ten latest whirls add."""
        (shed,), message = self.phases(time=time), np.full_like(place, [0.0, -0.2])
        for number in range(int(shed) - 9, int(shed) + 1):
            side, age = number % 2 * 2 - 1, (shed - number) / 10.0
            centre = np.array([0.7 * side * self.rock, -25.0 * self.rock * age], np.float32)
            away = (place - centre) / (self.rock * (0.6 + 0.8 * age))
            turn = side * self.strength * min(10.0 * age, 1.0 - age**2) * np.exp(0.5 - 0.5 * (away**2).sum(axis=1))
            message += turn[:, None] * np.stack([away[:, 1], -away[:, 0]], axis=1)
        return np.asarray(message / np.maximum(1.0, np.linalg.norm(message, axis=1, keepdims=True)))

    def twin_values(self, *, time: float, seed: int) -> TwinValues:
        """Return the numbers that its twin reads in addition to its fields: side and age of the latest whirl."""
        latest, age = divmod(self.phases(time=time)[0], 1.0)
        return TwinValues({"side": latest % 2 * 2 - 1, "age": age})
