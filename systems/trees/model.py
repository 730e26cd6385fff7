"""Models of a kind of tree: grown once, and drawn many times."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.declared.tree import HabitName
from .bake import picture_size
from .bark import Wood, bark_of
from .bounds import Balls, blocks_of, grouped, near_wood, twig_balls, wood_balls
from .crown import leaf_area, shade_of, shading
from .grow import Tree, grown
from .habit import HABITS, Habit
from .motion import limb_hertz, trunk_hertz
from .twig import TWIG

MODELS = 2
"""Models grown of a kind: each stands for many trees, turned and scaled."""

MARGIN = 1.04
"""Half the breadth and height of a tree's pictures, relative to its twigs' reach: leaves go beyond the twigs."""


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A grown tree, as shaders read it."""

    habit: Habit
    height: float
    """[m]."""

    twigs: NDArray[np.void]
    """Records of `TWIG`, in an order whose every start is a fair sample, shape (n,)."""

    limbs: NDArray[np.void]
    """Its limbs as records of `TWIG`, shape (n,)."""

    vertices: NDArray[np.void]
    """Records of `BARK`, shape (n,)."""

    wood: tuple[Wood, ...]
    """Triangles of these, for each of `PIXEL_RADII` and beyond; next to the eye in blocks of neighbours."""

    near_blocks: tuple[Balls, Balls]
    """Bounds of these blocks: of the whole wood, and of its edges."""

    middle: float
    """Height of the middle of its pictures [m]."""

    half: float
    """Half the height of its pictures [m]."""

    lines: int
    """Height of its pictures [texels]."""

    wide: int
    """Width of its pictures [texels]."""

    radius: float
    """Radius of its crown about the trunk [m]."""

    balls: Balls
    """Bounds of its twigs."""

    blocks: Balls
    """Bounds of the blocks that its twigs are grouped into."""

    hertz: float
    """Frequency of its trunk [Hz]."""

    leaf_area: float
    """Area of all its leaves, one side [m²]."""

    @property
    def aspect(self) -> float:
        """Height of its pictures, relative to their width."""
        return self.lines / self.wide

    @property
    def shade(self) -> tuple[float, float, float]:
        """Its shade on the grass, as `shade_of` returns it."""
        return shade_of(self.leaf_area, self.radius, self.height, 0.5 * self.habit.slender * self.height)


@lru_cache(maxsize=32)
def models_of(name: HabitName, seed: int, /) -> tuple[Model, ...]:
    """Return the models of a habit that grow from a seed."""
    habit = HABITS[name]
    low, high = habit.height
    return tuple(_model(habit, low + (high - low) * (n + 0.5) / MODELS, seed=seed + n) for n in range(MODELS))


def _model(habit: Habit, height: float, *, seed: int) -> Model:
    tree = grown(habit, height, seed=seed)
    area = leaf_area(tree.twigs, habit.leaf, habit.twigs.length)
    limbs = _limb_records(tree, seed)
    twigs = _twig_records(tree, area, limbs)
    vertices, wood = bark_of(tree, area, len(twigs), limbs["limb"])
    ends = tree.twigs.foot + tree.twigs.length[:, None] * tree.twigs.along
    balls = twig_balls(twigs, height, habit)
    bark_balls = wood_balls(vertices, np.concatenate([twigs, limbs]), height)
    nearest, near_blocks = near_wood(wood[0], vertices, bark_balls)
    radius = float(np.hypot(ends[:, 0], ends[:, 2]).max())
    top = float(ends[:, 1].max())
    half = MARGIN * max(0.5 * top, radius)  # a picture from above is as high as the tree is broad
    return Model(
        habit, height, twigs, limbs, vertices, (nearest, *wood[1:]), near_blocks, 0.5 * top, half,
        *picture_size(MARGIN * radius / half), radius, balls, blocks_of(balls, twigs["grouped"].astype(np.intp)),
        trunk_hertz(height, habit.slender * height), float(area.sum()),
    )  # fmt: skip


def _limb_records(tree: Tree, seed: int) -> NDArray[np.void]:
    """Return the limbs as records of `TWIG`."""
    limbs = tree.levels[1]
    records = np.zeros(len(limbs.at), TWIG)
    records["pivot"] = limbs.spine[:, 0]
    records["limb"] = np.random.default_rng((seed, 43)).uniform(0.0, 1.0, len(limbs.at))
    records["hertz"] = [limb_hertz(each) for each in limbs.length]
    return records


def _twig_records(tree: Tree, area: Doubles, limbs: NDArray[np.void]) -> NDArray[np.void]:
    twigs = tree.twigs
    records = np.zeros(len(twigs.foot), TWIG)
    for name in ("foot", "along", "face"):
        records[name] = getattr(twigs, name)
    records["span"] = twigs.length  # strict GLSL compilers take `length` for a method
    for name in ("pivot", "limb", "hertz"):
        records[name] = limbs[name][twigs.limb]
    middle = twigs.foot + 0.5 * twigs.length[:, None] * twigs.along.astype(np.float64)
    records["shading"] = shading(tree, area, middle)
    records["grouped"] = grouped(middle)
    return records
