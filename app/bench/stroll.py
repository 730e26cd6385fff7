"""The walk and the climb that changes are measured on: the same every time, and laid out in any scene."""

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
"""Frames per second: what pops, pops from one frame to the next, however short a frame is."""

PACE = 1.6
"""How fast the walker goes [m/s]."""

TURN = math.radians(20.0)
"""How fast it turns its head where it does [rad/s]."""

PITCH = math.radians(-5.0)
"""Where it looks."""

LEAD = 0.12
"""When each leg comes to the first border between patches [s]: between two frames, never on one."""

SECONDS = 1.4
"""How long a leg lasts: its patches change, and are done [s]."""

REST = 4.0
"""Time between two legs, in which everything settles [s]."""

BEHIND = 12.0
"""How far before and behind a crest the ground must be lower [m]."""

RISE = 0.5
"""By how much it must be [m]."""

SEARCHED = 90.0
"""How far from the camera a crest is looked for [m]."""

TOP = 60.0
"""How high above the ground the climb ends [m]."""

DOWN = math.radians(90.0)
"""How far below the horizon it looks in the end [rad]."""


@dataclass(frozen=True, slots=True)
class Leg:
    """A straight part of the walk."""

    name: str

    start: float
    """When it begins [s]."""

    place: tuple[float, float]
    """Ground position (x, z) where it begins [m]."""

    heading: float
    """Where the walker goes, as a camera's yaw [rad]."""

    yaw: float
    """Where it looks at first [rad]."""

    turn: float = 0.0
    """How fast it turns to the right [rad/s]."""

    back: bool = False
    """Whether it goes back again at half time."""

    pace: float = PACE
    """How fast it goes [m/s]."""

    height: float = EYE
    """How high above the ground its eyes are at first [m]."""

    rise: float = 0.0
    """How fast they rise [m/s]."""

    pitch: float = PITCH
    """Where it looks at first, as a camera's pitch [rad]."""

    tilt: float = 0.0
    """How fast it comes to look down [rad/s]."""

    @property
    def by_border(self) -> bool:
        """Whether patches change where it comes to its border, and not all along it."""
        return not (self.rise or self.tilt)

    def camera(self, time: float, view: float, height_at: Heights) -> Camera:
        """Return the camera `time` [s] after the beginning, with a vertical angle of view [rad]."""
        way = min(time, SECONDS - time) if self.back else time
        x, z = np.array(self.place) + self.pace * way * ahead(self.heading)
        y = float(height_at(np.array([[x, z]], np.float32))[0]) + self.height + self.rise * time
        return Camera((float(x), y, float(z)), self.yaw + self.turn * time, self.pitch - self.tilt * time, view)


@dataclass(frozen=True, slots=True)
class Moment:
    """One frame of the walk."""

    leg: Leg
    number: int
    """Frame of its leg, from 0."""

    time: float
    """Instant of the prairie [s]."""

    camera: Camera


def ahead(yaw: float, /) -> Doubles:
    """Return the ground direction (x, z) of a yaw [rad], shape (2,)."""
    return np.array([math.sin(yaw), -math.cos(yaw)])


def first_border(place: Doubles, heading: float, /, *, patch: float) -> float:
    """Return how far it is to the first border between patches [m] from a ground position (2,) along a heading."""
    way = ahead(heading)
    border = (np.floor(place / patch) + (way > 0.0)) * patch
    moving = np.abs(way) > 1e-9
    return float(((border - place)[moving] / way[moving]).min())


def legs(prairie: Prairie, /) -> list[Leg]:
    """Return the walk through a prairie: ahead, aside and back, turning, and towards and over a crest if it has one.

    It begins at the scene's camera, and each leg comes to a border between patches after `LEAD` seconds.
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
    """Return a crest's place (2,) and the heading that leads over it, or None where the terrain has none.

    Of the places within `SEARCHED` it is the one from which the ground falls the most, before and behind.
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


def raise_gusts(prairie: Prairie, walk: list[Leg], /) -> None:
    """Let a gust cross what is seen on each leg."""
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
    """Return the climb over a prairie, at its camera's place: legs on which it rises, and then legs on which it tilts.

    Each begins where the one before ended, and all take as long as those of a walk; it is no faster than a flyer, and
    turns its head no faster than a walker.
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
