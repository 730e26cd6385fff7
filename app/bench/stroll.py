"""The walk and the climb on which changes of representation are measured: planned for a scene, the same every time."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...components.arrays import Doubles
from ...engine.camera import Camera, Heights, camera_at
from ...systems.prairie import Prairie
from ...systems.wind.gust import Gust
from ..studio.walker import EYE, FLY, MARGIN

RATE = 30
"""Frames per second. The rate matters little: popping happens between two frames, however short they are."""

PACE = 1.6
"""Walking speed [m/s]."""

TURN = math.radians(20.0)
"""Rate of turning and of tilting the head [rad/s]."""

PITCH = math.radians(-5.0)
"""Camera pitch on the walk [rad]."""

LEAD = 0.12
"""Time in a leg at which it crosses the first border between patches [s]: between two frames, never on one."""

SECONDS = 1.4
"""Duration of a leg, in which its patches change and finish changing [s]."""

REST = 4.0
"""Pause between two legs, in which everything settles [s]."""

BEHIND = 12.0
"""Distance before and behind a crest at which the ground must be lower [m]."""

RISE = 0.5
"""Least height of a crest above the ground there [m]."""

SEARCHED = 90.0
"""Half the side of the square around the camera in which a crest is searched [m]."""

TOP = 60.0
"""Height above the ground at which the climb ends [m]."""

DOWN = math.radians(90.0)
"""Angle below the horizon to which the climb tilts in the end [rad]."""


@dataclass(frozen=True, slots=True)
class Leg:
    """A straight part of the walk."""

    name: str

    start: float
    """Instant at which it begins [s]."""

    place: tuple[float, float]
    """Ground position (x, z) where it begins [m]."""

    heading: float
    """Direction of motion, as a camera's yaw [rad]."""

    yaw: float
    """Camera yaw at the beginning [rad]."""

    turn: float = 0.0
    """Rate of the yaw, positive to the right [rad/s]."""

    back: bool = False
    """Whether the walker turns back at half time."""

    pace: float = PACE
    """Speed over ground [m/s]."""

    height: float = EYE
    """Height of the eye above the ground at the beginning [m]."""

    rise: float = 0.0
    """Speed at which the eye rises [m/s]."""

    pitch: float = PITCH
    """Camera pitch at the beginning [rad]."""

    tilt: float = 0.0
    """Rate at which the pitch falls [rad/s]."""

    @property
    def by_border(self) -> bool:
        """Whether patches change at its first border only, and not all along it."""
        return not (self.rise or self.tilt)

    def camera(self, time: float, view: float, height_at: Heights) -> Camera:
        """Return the camera `time` [s] after the beginning, with a vertical angle of view [rad]."""
        walked = min(time, SECONDS - time) if self.back else time
        x, z = np.array(self.place) + self.pace * walked * ahead(self.heading)
        y = float(height_at(np.array([[x, z]], np.float32))[0]) + self.height + self.rise * time
        return Camera((float(x), y, float(z)), self.yaw + self.turn * time, self.pitch - self.tilt * time, view)


@dataclass(frozen=True, slots=True)
class Moment:
    """One frame of the walk."""

    leg: Leg
    number: int
    """Index of the frame in its leg, from 0."""

    time: float
    """Instant of the prairie [s]."""

    camera: Camera


def ahead(yaw: float, /) -> Doubles:
    """Return the ground direction (x, z) of a yaw [rad], shape (2,)."""
    return np.array([math.sin(yaw), -math.cos(yaw)])


def first_border(place: Doubles, heading: float, /, *, patch: float) -> float:
    """Return the distance to the first border between patches [m] from a ground position (2,) along a heading."""
    direction = ahead(heading)
    border = (np.floor(place / patch) + (direction > 0.0)) * patch
    moving = np.abs(direction) > 1e-9
    return float(((border - place)[moving] / direction[moving]).min())


def legs(prairie: Prairie, /) -> list[Leg]:
    """Return the walk through a prairie: ahead, aside and back, turning, and towards and over a crest if there is one.

    It begins at the scene's camera. Each leg crosses a border between patches after `LEAD` seconds.
    """
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    place, yaw = np.array([camera.position[0], camera.position[2]]), camera.yaw
    right = yaw + math.pi / 2
    planned = [("ahead", place, yaw, yaw, 0.0), ("aside", place, right, yaw, 0.0), ("turning", place, yaw, yaw, TURN)]
    crest = find_crest(prairie, place)
    if crest is not None:
        top, over = crest
        *_, blades, strips, _ = prairie.site.reach
        patch = prairie.site.ground.patch
        for name, away in (("below", (blades + 1) * patch), ("far", (strips + 1) * patch), ("over", 2.0)):
            planned.append((name, top - away * ahead(over), over, over, 0.0))
    return [_leg(prairie, number, *row) for number, row in enumerate(planned)]


def _leg(prairie: Prairie, number: int, name: str, place: Doubles, heading: float, yaw: float, turn: float) -> Leg:
    patch = prairie.site.ground.patch
    half = np.maximum(np.asarray(prairie.site.ground.terrain.size) / 2.0 - MARGIN - PACE * SECONDS, 0.0)
    inside = np.clip(place, -half, half)
    start = inside + (first_border(inside, heading, patch=patch) - PACE * LEAD) * ahead(heading)
    begin = REST + number * (SECONDS + REST)
    return Leg(name, begin, (float(start[0]), float(start[1])), heading, yaw, turn, name == "aside", pitch=PITCH)


def find_crest(prairie: Prairie, place: Doubles, /) -> tuple[Doubles, float] | None:
    """Return a crest's ground position (2,) and the heading [rad] that leads over it, or None without a crest.

    Within `SEARCHED` it is the place from which the ground falls the most, before and behind.
    """
    half = np.asarray(prairie.site.ground.terrain.size) / 2.0 - BEHIND
    low, high = np.maximum(place - SEARCHED, -half), np.minimum(place + SEARCHED, half)
    if (high <= low).any():
        return None
    grid = np.stack(np.meshgrid(*(np.arange(a, b, 3.0) for a, b in zip(low, high, strict=True))), -1).reshape(-1, 2)
    headings = np.arange(8) * (math.pi / 4)

    def heights(places: Doubles) -> Doubles:
        return np.asarray(prairie.height_at(places), np.float64)

    falls = [
        heights(grid) - np.maximum(heights(grid - BEHIND * ahead(each)), heights(grid + BEHIND * ahead(each)))
        for each in headings
    ]
    best = np.unravel_index(np.argmax(falls), (len(headings), len(grid)))
    if falls[best[0]][best[1]] < RISE:
        return None
    return grid[best[1]], float(headings[best[0]])


def moments(prairie: Prairie, leg: Leg, /) -> Iterator[Moment]:
    """Yield the frames of a leg."""
    view = math.radians(prairie.scene.camera.view)
    for number in range(round(SECONDS * RATE) + 1):
        time = number / RATE
        yield Moment(leg, number, leg.start + time, leg.camera(time, view, prairie.height_at))


def advance_to(prairie: Prairie, time: float, /) -> None:
    """Move a prairie on to an instant [s], unless it is already there or later."""
    prairie.advance(max(0.0, time - prairie.time))


def raise_gusts(prairie: Prairie, walk: list[Leg], /) -> None:
    """Add a gust to each leg that crosses the camera's view."""
    for leg in walk:
        side = leg.yaw + math.pi / 3
        x, z = np.array(leg.place) + 12.0 * ahead(leg.yaw) - 14.0 * ahead(side)
        prairie.add(
            Gust(
                position=[float(x), float(z)], direction=math.degrees(math.remainder(side, math.tau)),
                start=leg.start - 1.5, stop=leg.start + SECONDS + 1.0, width=80.0, speed=8.0, strength=0.7,
            ),
            name=f"gust of the leg {leg.name}",
        )  # fmt: skip


def climb(prairie: Prairie, /) -> list[Leg]:
    """Return the climb at the place of the scene's camera: legs that rise, and then legs that tilt down.

    Each begins where the one before ended, and lasts as long as a leg of the walk. It rises no faster than `FLY` and
    tilts no faster than `TURN`.
    """
    rising = math.ceil((TOP - EYE) / (FLY * SECONDS))
    tilting = math.ceil((DOWN + PITCH) / (TURN * SECONDS))
    rise = (TOP - EYE) / (rising * SECONDS)
    tilt = (DOWN + PITCH) / (tilting * SECONDS)
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    half = np.asarray(prairie.site.ground.terrain.size) / 2.0
    x, z = np.clip(camera.position[::2], -half, half).tolist()

    plain = Leg("", 0.0, (x, z), camera.yaw, camera.yaw, pace=0.0)
    walk = []
    for number in range(rising):
        height = EYE + number * rise * SECONDS
        walk.append(replace(plain, name=f"up-{height:.0f}", height=height, rise=rise))
    for number in range(tilting):
        pitch = PITCH - number * tilt * SECONDS
        walk.append(replace(plain, name=f"tilt-{-math.degrees(pitch):.0f}", height=TOP, pitch=pitch, tilt=tilt))
    return [replace(leg, start=REST + number * (SECONDS + REST)) for number, leg in enumerate(walk)]
