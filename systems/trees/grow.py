"""Growing a tree's wood, level by level (Weber and Penn, Creation and Rendering of Realistic Trees, 1995)."""

from dataclasses import dataclass

import numpy as np

from ...components.arrays import Doubles, Floats, Indices
from .habit import GOLDEN, Habit, Shoots

POINTS = 14, 9, 4
"""Points along a stem of each level."""

PIPE = 2.2
"""Power of radii whose sum is kept where a stem forks: da Vinci's 2, as measured 1.8 to 2.3 (Minamino and Tateno, Tree
Branching: Leonardo da Vinci's Rule versus Biomechanical Models, 2014)."""

THINNEST = 0.004
"""Radius at the end of a branch [m]."""

MOST_TWIGS = 3600
"""Greatest number of twigs. Of more, a sample is kept, each larger so that the leaf area stays."""


@dataclass(frozen=True, slots=True, eq=False)
class Stems:
    """Stems of one level."""

    spine: Doubles
    """Points from foot to tip [m], shape (n, points, 3); y is up."""

    parent: Indices
    """Index of the bearing stem in the level before, shape (n,)."""

    at: Doubles
    """Position of the foot along the bearing stem, relative to its length, shape (n,)."""

    radius: Doubles
    """Radius at each point [m], shape (n, points)."""

    @property
    def length(self) -> Doubles:
        """Length of each [m], shape (n,)."""
        return np.asarray(np.linalg.norm(np.diff(self.spine, axis=1), axis=-1).sum(axis=1))


@dataclass(frozen=True, slots=True, eq=False)
class Twigs:
    """The ends of a tree, which bear its leaves."""

    foot: Floats
    """[m], shape (n, 3)."""

    along: Floats
    """Direction of each, unit vectors (n, 3)."""

    face: Floats
    """Normal of the plane of its leaves, unit vectors (n, 3), perpendicular to `along`."""

    length: Floats
    """[m], shape (n,)."""

    limb: Indices
    """Index of the limb that bears it, shape (n,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Tree:
    """A grown tree: trunk, limbs, branches and twigs."""

    levels: tuple[Stems, Stems, Stems]
    twigs: Twigs
    height: float
    """[m]."""

    limb_of: Indices
    """Index of the limb that bears each branch, shape (branches,)."""


def grown(habit: Habit, height: float, /, *, seed: int) -> Tree:
    """Return the tree that grows from a seed to a height [m]."""
    draw = np.random.default_rng((seed, 42))
    trunk = _trunk(habit, height, draw)
    limbs = _limbs(habit, trunk, height, draw)
    branches = _shoots(habit.branches, limbs, draw, points=POINTS[2], relative=True)
    twigs, bearer = _twigs(habit.twigs, branches, draw)
    levels = _thickened(trunk, limbs, branches, bearer, habit.slender * height / 2.0)
    top = max(float(twigs.foot[:, 1].max()), 1e-3)
    return _scaled(Tree(levels, twigs, height, branches.parent), height / (top + 0.3 * habit.twigs.length))


def _trunk(habit: Habit, height: float, draw: np.random.Generator) -> Stems:
    start = np.array([[0.0, 1.0, 0.0]])
    spine = _spines(np.zeros((1, 3)), start, np.array([height]), POINTS[0], 0.25, 0.3 * (1.0 - habit.straight), draw)
    return Stems(spine, np.zeros(1, np.intp), np.zeros(1), np.zeros((1, POINTS[0])))


def _limbs(habit: Habit, trunk: Stems, height: float, draw: np.random.Generator) -> Stems:
    shoots = habit.limbs
    count = max(round(shoots.each), 1)
    order = np.arange(count) // habit.whorled * habit.whorled if habit.whorled > 1 else np.arange(count)
    place = (order + draw.uniform(0.0, 0.4, count)) / count
    at = habit.bare + (0.985 - habit.bare) * place
    around: Doubles = np.arange(float(count)) * (GOLDEN if habit.whorled == 1 else 2.0 * np.pi / habit.whorled)
    around = around + order * 0.7 + draw.normal(0.0, 0.25, count)
    profile = np.interp(place, np.linspace(0.0, 1.0, len(habit.crown)), habit.crown)
    length = height * shoots.length * profile * draw.uniform(0.78, 1.08, count)
    down = np.interp(place, (0.0, 1.0), shoots.down) * draw.normal(1.0, 0.1, count)
    parent = np.zeros(count, np.intp)
    foot, start = _junctions(trunk, parent, at, down, around)
    spine = _spines(foot, start, length, POINTS[1], shoots.lift, shoots.crook, draw)
    return Stems(spine, parent, at, np.zeros((count, POINTS[1])))


def _shoots(
    shoots: Shoots, on: Stems, draw: np.random.Generator, /, *, points: int, relative: bool
) -> Stems:  # fmt: skip
    """Return the stems that `on` bears: more on longer ones, shorter towards the tips."""
    lengths = on.length
    counts = np.maximum(np.round(shoots.each * lengths + draw.uniform(-0.5, 0.5, len(lengths))), 2).astype(np.intp)
    parent = np.repeat(np.arange(len(lengths)), counts)
    number = np.arange(len(parent)) - np.repeat(np.cumsum(counts) - counts, counts)
    at = np.clip(0.12 + 0.88 * (number + draw.uniform(0.2, 0.8, len(parent))) / counts[parent], 0.0, 1.0)
    # Side shoots of a limb are about level: to its left and right in turn, rather than above and below.
    around = np.pi * (number % 2) + draw.normal(0.0, 0.75, len(parent))
    down = np.interp(at, (0.0, 1.0), shoots.down) * draw.normal(1.0, 0.18, len(parent))
    length = shoots.length * (1.0 - 0.55 * at) * draw.uniform(0.7, 1.15, len(parent))
    length = np.maximum(length * lengths[parent] if relative else length, 0.12)
    foot, start = _junctions(on, parent, at, down, around)
    spine = _spines(foot, start, length, points, shoots.lift, shoots.crook, draw)
    return Stems(spine, parent, at, np.zeros((len(parent), points)))


def _twigs(shoots: Shoots, branches: Stems, draw: np.random.Generator) -> tuple[Twigs, Indices]:
    """Return the twigs, and the index of the branch that bears each."""
    stems = _shoots(shoots, branches, draw, points=3, relative=False)
    # One more twig continues each branch at its end.
    tip, last = branches.spine[:, -1], branches.spine[:, -1] - branches.spine[:, -2]
    foot = np.concatenate([stems.spine[:, 0], tip])
    way = np.concatenate([stems.spine[:, -1] - stems.spine[:, 0], last / np.linalg.norm(last, axis=1, keepdims=True)])
    lengths = np.linalg.norm(way[: len(stems.at)], axis=1)
    length = np.concatenate([lengths, draw.uniform(0.8, 1.1, len(tip)) * shoots.length])
    bearer = np.concatenate([stems.parent, np.arange(len(tip))])
    chosen, larger = _sampled(len(foot), draw)
    hangs = np.array([0.0, 2.0 * min(shoots.lift, 0.0), 0.0])  # shoots that turn downwards hang at their end
    along = _normalized(_normalized(way[chosen]) + hangs)
    face = _perpendicular(along, np.array([0.0, 1.0, 0.0]) + draw.normal(0.0, 0.45, along.shape))
    bearer = bearer[chosen]
    found = [each.astype(np.float32) for each in (foot[chosen], along, face, length[chosen] * larger)]
    return Twigs(found[0], found[1], found[2], found[3], branches.parent[bearer]), bearer


def _sampled(count: int, draw: np.random.Generator) -> tuple[Indices, float]:
    """Return the indices of twigs that are kept, in an order whose every start is a fair sample; and their scale."""
    order = draw.permutation(count)
    kept = order[:MOST_TWIGS]
    return kept, float(np.sqrt(count / len(kept)))


def _thickened(trunk: Stems, limbs: Stems, branches: Stems, bearer: Indices, base: float) -> tuple[Stems, Stems, Stems]:
    """Return stems with radii that follow from the twigs each point carries; `base` is the trunk's at its foot [m]."""
    on_branch = np.bincount(bearer, minlength=len(branches.at)).astype(np.float64)
    last = POINTS[2] - 1
    carried = on_branch[:, None] * (1.0 - np.arange(last + 1) / (last + 1.0)) + 1.0
    on_limb = _carried(branches, carried[:, 0], len(limbs.at), POINTS[1]) + 1.0
    on_trunk = _carried(limbs, on_limb[:, 0], 1, POINTS[0]) + 1.0
    unit = base / on_trunk[0, 0] ** (1.0 / PIPE)
    found = []
    for stems, count in ((trunk, on_trunk), (limbs, on_limb), (branches, carried)):
        radius = np.maximum(unit * count ** (1.0 / PIPE), THINNEST)
        radius[:, -1] = THINNEST
        found.append(Stems(stems.spine, stems.parent, stems.at, radius))
    return found[0], found[1], found[2]


def _carried(stems: Stems, count: Doubles, bearers: int, points: int) -> Doubles:
    """Return the sum of `count` of the stems at or beyond each point of what bears them, (bearers, points)."""
    sums = np.zeros((bearers, points))
    np.add.at(sums, (stems.parent, np.minimum((stems.at * (points - 1)).astype(np.intp) + 1, points - 1)), count)
    return np.cumsum(sums[:, ::-1], axis=1)[:, ::-1]


def _junctions(on: Stems, parent: Indices, at: Doubles, down: Doubles, around: Doubles) -> tuple[Doubles, Doubles]:
    """Return the feet of shoots and their directions: angles `down` from the bearing stem and `around` it [rad]."""
    points = on.spine.shape[1]
    place = at * (points - 1)
    low = np.minimum(place.astype(np.intp), points - 2)
    part = (place - low)[:, None]
    first, second = on.spine[parent, low], on.spine[parent, low + 1]
    along = _normalized(second - first)
    aside = _perpendicular(along, np.array([0.0, 1.0, 0.0]) + 1e-3)
    level = np.cross(along, aside)
    # Measured from the horizontal: 0 and half a turn are left and right of a limb.
    out = np.cos(around)[:, None] * level + np.sin(around)[:, None] * aside
    return first + part * (second - first), np.cos(down)[:, None] * along + np.sin(down)[:, None] * out


def _spines(
    foot: Doubles, start: Doubles, length: Doubles, points: int, lift: float, crook: float, draw: np.random.Generator
) -> Doubles:
    """Return the points (n, points, 3) of stems that turn at each step."""
    spine, direction = np.empty((len(foot), points, 3)), _normalized(start)
    spine[:, 0] = foot
    stride = (length / (points - 1))[:, None]
    for point in range(1, points):
        spine[:, point] = spine[:, point - 1] + stride * direction
        turned = direction + draw.normal(0.0, crook, direction.shape)
        turned[:, 1] += lift
        direction = _normalized(turned)
    return spine


def _scaled(tree: Tree, scale: float) -> Tree:
    levels = tuple(Stems(each.spine * scale, each.parent, each.at, each.radius) for each in tree.levels)
    twigs = tree.twigs
    foot = np.asarray(twigs.foot * np.float32(scale))
    return Tree(
        (levels[0], levels[1], levels[2]), Twigs(foot, twigs.along, twigs.face, twigs.length, twigs.limb),
        tree.height, tree.limb_of,
    )  # fmt: skip


def _normalized(vector: Doubles) -> Doubles:
    return np.asarray(vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-12))


def _perpendicular(along: Doubles, toward: Doubles) -> Doubles:
    """Return unit vectors perpendicular to `along`, as near to `toward` as possible."""
    toward = np.broadcast_to(toward, along.shape)
    rest = toward - along * (along * toward).sum(axis=-1, keepdims=True)
    flat = np.linalg.norm(rest, axis=-1, keepdims=True) < 1e-2
    return _normalized(np.where(flat, np.cross(along, np.array([1.0, 0.0, 0.0])) + 1e-6, rest))
