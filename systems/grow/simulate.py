"""Physical simulation of blades in the plane: chains of rigid links with springs at their joints.

Units inside a chain are the blade's own: its length, its mass and the acceleration of gravity are 1, so that
time runs in units of sqrt(length / gravity). Angles are absolute, from the vertical [rad].
"""

from dataclasses import dataclass, replace

import numpy as np

from ...components.arrays import Doubles
from ...engine.declared.grass import GrassKind

GRAVITY = 9.81
LINKS = 16

_MARGIN = 1.2
"""Stiffness of a common blade beyond the least that carries its own weight, as a fraction of that."""

_DAMPING_RATIO = 0.08
"""Fraction of critical damping in the slowest swing of a common blade, without that of the air."""

_AREAL_DENSITY = 0.32
"""Mass per area of a common blade half a metre long [kg/m2]."""

_DRAG = 0.5 * 1.2 * 1.2
"""Half the density of air times the drag coefficient of a flat plate [kg/m3]."""

_SLENDERNESS = 0.022
"""Width over length of a common blade."""

_MOST_TRIES, _LONGEST_TURN, _AT_REST = 60, 0.2, 1e-9
"""Newton's method for a blade at rest: most steps; largest turn of a link in a step; turn at which it ends [rad]."""

_BREATH = 0.12
"""Force of the wind on a sagging blade, relative to its weight: it hangs to one side, and sags gradually."""


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """A batch of blades, each a chain of links clamped at its root."""

    mass: Doubles
    """Mass of each link, shape (links,)."""

    area: Doubles
    """Drag of each link per squared speed across it, shape (links,)."""

    stiffness: Doubles
    """Stiffness of the spring below each link, shape (batch, links)."""

    damping: Doubles
    """Viscous damping of the joint below each link, shape (batch, links)."""

    second: float
    """Number of units of time in a second."""


def build_chain(kind: GrassKind, factors: Doubles, /) -> Chain:
    """Return the chains of a kind of grass whose joints are stiffer by `factors`, shape (batch, links).

    A plant grows as thick as its height demands: stiffness is a multiple of the least that carries the blade's
    own weight, so every kind stands. Width decides how thick the blade is for its height.
    """
    length = 0.5 * (kind.height[0] + kind.height[1])
    thickness = np.sqrt(np.clip(kind.width / (length * _SLENDERNESS), 0.25, 4.0))
    density = _AREAL_DENSITY * (length / 0.5) ** 1.5 * thickness
    mass, least = _least_stiffness(kind, factors)
    stiffness = least * (1.0 + _MARGIN * kind.stiffness * thickness**2)
    chain = Chain(mass, mass * _DRAG * length / density, stiffness, stiffness, float(np.sqrt(GRAVITY / length)))
    return damp(chain, ratio=_DAMPING_RATIO * kind.damping)


def _least_stiffness(kind: GrassKind, factors: Doubles, /) -> tuple[Doubles, Doubles]:
    """Return the mass of each link, shape (links,), and the least stiffness of joints that carries the blade.

    Joints are stiffer by `factors`; both have the shape (batch, links).
    """
    links = factors.shape[1]
    breadth = (1.0 - (np.arange(links) + 0.5) / links) ** kind.taper
    mass = breadth / breadth.sum()
    along = np.arange(links) / links
    profile = ((1.0 - along) ** kind.taper * (1.0 - 0.7 * along) ** 2) * factors
    return mass, np.asarray(profile / _buckling_load(profile, mass)[:, None])


def sag(kind: GrassKind, factors: Doubles, weights: Doubles, /) -> Doubles:
    """Return the angles of blades that sag under their weight, shape (weights, batch, links).

    `weights` (weights,) rise from a fraction of what the blades carry to more than that; a breath of wind decides to
    which side they hang. Joints are stiffer by `factors`, shape (batch, links).
    """
    mass, least = _least_stiffness(kind, factors)
    load, stiff, reach = _load(mass), _joint_matrix(least), _reach(len(mass))
    angle, push = np.zeros(factors.shape), _BREATH * mass
    sagged = np.empty((len(weights), *factors.shape))
    for number, weight in enumerate(weights):
        sagged[number] = angle = _rest(angle, stiff / weight, load, reach, push)
    return sagged


def damp(chain: Chain, /, *, ratio: float) -> Chain:
    """Return the chains with joints that give the slowest swing this `ratio` of critical damping."""
    return replace(chain, damping=chain.stiffness * (2.0 * ratio / lowest_swing(chain))[:, None])


def place_links(angle: Doubles, /) -> Doubles:
    """Return the control points (along, up) of blades of length 1, shape (..., links + 1, 2), from their angles."""
    steps = np.stack([np.sin(angle), np.cos(angle)], axis=-1) / angle.shape[-1]
    points = np.zeros((*angle.shape[:-1], angle.shape[-1] + 1, 2))
    np.cumsum(steps, axis=-2, out=points[..., 1:, :])
    return points


def lowest_swing(chain: Chain, /) -> Doubles:
    """Return the angular frequency of the slowest small swing about the upright blade, shape (batch,)."""
    stiff = _joint_matrix(chain.stiffness) - np.diag(_load(chain.mass))
    values = np.linalg.eigvals(np.linalg.solve(_inertia(chain.mass)[None], stiff))
    return np.asarray(np.sqrt(values.real.min(axis=1)))


def simulate(chain: Chain, angle: Doubles, rate: Doubles, wind: Doubles, /, *, step: float) -> tuple[Doubles, Doubles]:
    """Return angles over time, shape (steps + 1, batch, links), and the last rates, shape (batch, links).

    `angle` and `rate` are the start, shape (batch, links); `wind` is the horizontal wind's speed at each
    step, shape (steps, batch). Linearly implicit in springs, damping and drag; all lengths stay exact, since
    positions are sums of unit vectors.
    """
    motion = _Motion(chain)
    history = np.empty((wind.shape[0] + 1, *angle.shape))
    history[0] = angle
    for number, speed in enumerate(wind):
        change = motion.change(history[number], rate, speed, step)
        history[number + 1] = history[number] + step * (rate + 0.5 * change)
        rate = rate + change
    return history, rate


class _Motion:
    """The equations of motion of a batch of chains, with their constant matrices."""

    def __init__(self, chain: Chain) -> None:
        links = chain.mass.shape[0]
        self._area = chain.area
        self._inertia = _inertia(chain.mass)
        self._load = _load(chain.mass)
        self._stiff = _joint_matrix(chain.stiffness)
        self._damp = _joint_matrix(chain.damping)
        self._reach = _reach(links)

    def change(self, angle: Doubles, rate: Doubles, wind: Doubles, step: float, /) -> Doubles:
        """Return the change of the rates over one step, shape (batch, links)."""
        middle = angle + 0.5 * step * rate
        sine, cosine = np.sin(middle), np.cos(middle)
        cosine_between = cosine[:, :, None] * cosine[:, None, :] + sine[:, :, None] * sine[:, None, :]
        sine_between = sine[:, :, None] * cosine[:, None, :] - cosine[:, :, None] * sine[:, None, :]
        across = self._reach * cosine_between
        speed = wind[:, None] * cosine - _times(across, rate)
        push = self._area * np.abs(speed)
        transposed = np.swapaxes(across, 1, 2)
        torque = _times(transposed, push * speed) + self._load * sine
        torque -= _times(self._inertia * sine_between, rate * rate)
        torque -= _times(self._stiff, middle) + _times(self._damp, rate)
        brake = self._damp + (transposed * (2.0 * push)[:, None, :]) @ across
        left = self._inertia * cosine_between + (0.5 * step) * brake + (0.25 * step * step) * self._stiff
        return np.asarray(np.linalg.solve(left, step * torque[:, :, None])[:, :, 0])


def settle(chain: Chain, wind: Doubles, /) -> Doubles:
    """Return the angles of blades at rest in constant winds, shape (winds, batch, links).

    `wind` is the horizontal wind's speed, rising from near nothing, shape (winds,); each rest is the start of the
    search for the next.
    """
    links = chain.mass.shape[0]
    load, stiff = _load(chain.mass), _joint_matrix(chain.stiffness)
    reach = _reach(links)
    angle = np.zeros(chain.stiffness.shape)
    rests = np.empty((len(wind), *angle.shape))
    for number, speed in enumerate(wind):
        rests[number] = angle = _rest(angle, stiff, load, reach, chain.area * speed * speed)
    return rests


def _rest(angle: Doubles, stiff: Doubles, load: Doubles, reach: Doubles, pressure: Doubles, /) -> Doubles:
    """Return the angles at which blades rest, shape (batch, links), by Newton's method from `angle`."""
    for _ in range(_MOST_TRIES):
        step = _newton_step(angle, stiff, load, reach, pressure)
        angle = angle + np.clip(step, -_LONGEST_TURN, _LONGEST_TURN)
        if np.abs(step).max() < _AT_REST:
            break
    return angle


def _newton_step(angle: Doubles, stiff: Doubles, load: Doubles, reach: Doubles, pressure: Doubles, /) -> Doubles:
    """Return Newton's step towards the balance of springs, weight and the wind's `pressure` on each link."""
    sine, cosine = np.sin(angle), np.cos(angle)
    between = angle[:, :, None] - angle[:, None, :]
    across, along = reach * np.cos(between), reach * np.sin(between)
    push = pressure * cosine * np.abs(cosine)
    push_slope = -2.0 * pressure * np.abs(cosine) * sine
    transposed = np.swapaxes(across, 1, 2)
    torque = _times(transposed, push) + load * sine - _times(stiff, angle)
    slope = transposed * push_slope[:, None, :] - np.swapaxes(along * push[:, :, None], 1, 2) - stiff
    diagonal = np.arange(angle.shape[1])
    slope[:, diagonal, diagonal] += load * cosine + (along * push[:, :, None]).sum(axis=1)
    return np.asarray(np.linalg.solve(slope, -torque[:, :, None])[:, :, 0])


def _times(matrix: Doubles, vector: Doubles, /) -> Doubles:
    return np.asarray((matrix @ vector[:, :, None])[:, :, 0])


def _reach(links: int, /) -> Doubles:
    """Return the shift of each link's middle (row) per turn of each link (column) of a straight blade."""
    return np.asarray((np.tri(links, k=-1) + 0.5 * np.eye(links)) / links)


def _above(mass: Doubles, /) -> Doubles:
    """Return the mass above each link, shape (links,)."""
    return np.asarray(np.cumsum(mass[::-1])[::-1] - mass)


def _inertia(mass: Doubles, /) -> Doubles:
    """Return the inertia matrix of links as thin rods; entry (i, j) is multiplied by cos(angle i - angle j)."""
    links = mass.shape[0]
    upper = np.maximum.outer(np.arange(links), np.arange(links))
    inertia = (_above(mass) + 0.5 * mass)[upper]
    np.fill_diagonal(inertia, _above(mass) + mass / 3.0)
    return np.asarray(inertia / links**2)


def _load(mass: Doubles, /) -> Doubles:
    """Return the torque of the weight on each link where it lies flat, shape (links,)."""
    return np.asarray((_above(mass) + 0.5 * mass) / mass.shape[0])


def _joint_matrix(joint: Doubles, /) -> Doubles:
    """Return the matrices that map angles to the torques of springs (batch, links), shape (batch, links, links)."""
    batch, links = joint.shape
    matrix = np.zeros((batch, links, links))
    link = np.arange(links)
    matrix[:, link, link] = joint
    matrix[:, link[:-1], link[:-1]] += joint[:, 1:]
    matrix[:, link[1:], link[:-1]] = matrix[:, link[:-1], link[1:]] = -joint[:, 1:]
    return matrix


def _buckling_load(profile: Doubles, mass: Doubles, /) -> Doubles:
    """Return the largest weight that joints of stiffness `profile` carry, relative to the blade's, shape (batch,)."""
    values = np.linalg.eigvals(np.linalg.solve(_joint_matrix(profile), np.diag(_load(mass))[None]))
    return np.asarray(1.0 / values.real.max(axis=1))
