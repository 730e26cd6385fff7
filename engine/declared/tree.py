"""Trees and bushes: what a scene declares of them."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from ...components.declaration import Color, Declaration, DeclarationError, Pair, rising
from ...components.tree import HIGHEST, LOWEST

HabitName = Literal["oak", "birch", "pine", "poplar", "willow", "hawthorn"]

MOST = 20_000
"""Trees of a kind in a scene at most."""

COLOURS = "leaf", "bark", "variety"
"""Keys that may change while trees stand."""


class TreeKind(Declaration):
    """A kind of tree or bush: how it grows, and where.

    Trees stand at `positions`, along `rows`, and by `density`. Where two would stand too near, the later one is left
    out; those of `density` come last.
    """

    habit: HabitName
    """How it grows: as an oak, birch, pine, poplar, willow or hawthorn, the last of which is a bush."""

    height: Annotated[Pair, rising("height must be [lowest, highest]", LOWEST, HIGHEST)] | None = None
    """Lowest and highest grown tree [m]; without it, what suits the habit."""

    foliage: float = Field(default=1.0, gt=0.0, le=1.0)
    """How many of its leaves it has, as a part of all: fewer in autumn, or where it ails."""

    leaf: Color | None = None
    """Colour of leaves in the sun; without it, what suits the habit."""

    bark: Color | None = None
    """Colour of bark; without it, what suits the habit."""

    variety: float = Field(default=0.12, ge=0.0, le=0.6)
    """How far trees differ in brightness and hue from one another, as a fraction."""

    young: float = Field(default=0.3, ge=0.0, le=1.0)
    """How many of its trees of `density` still grow, as a part of all: they are of all ages, and so of all heights."""

    positions: list[Pair] = Field(default=[], max_length=MOST)
    """Where single trees stand, ground positions (x, z) [m]; over holes of the terrain there are none."""

    rows: list[Annotated[list[Pair], Field(min_length=2, max_length=1000)]] = Field(default=[], max_length=1000)
    """Lines of ground positions (x, z) [m] with trees along them, `spacing` apart: avenues and hedges, as far as there
    is ground."""

    spacing: float = Field(default=6.0, ge=0.3, le=1000.0)
    """Distance from tree to tree in a row, and the least distance among those of `density` [m]."""

    uneven: float = Field(default=0.0, ge=0.0, le=1.0)
    """How unevenly trees stand along rows: with 1, some are as far from where `spacing` has them as the next one, and
    one in eight is missing."""

    density: float = Field(default=0.0, ge=0.0, le=5000.0)
    """How many trees a hectare has besides, as far as there is room."""

    groves: float = Field(default=0.0, ge=0.0, le=1.0)
    """How much trees of `density` stand together: 0 is all over, 1 leaves open ground between dense groves."""

    among: str | None = None
    """Name of a kind of grass: trees of `density` stand where its map has it. Without it, everywhere."""

    slope: float = Field(default=40.0, ge=0.0, le=90.0)
    """Steepest slope that trees of `density` stand on [degrees]."""

    @property
    def uncoloured(self) -> "TreeKind":
        """The kind but for its colours: what stands where, and how high."""
        return self.model_copy(update={name: type(self).model_fields[name].default for name in COLOURS})

    @model_validator(mode="after")
    def _stands_apart(self) -> "TreeKind":
        for number, row in enumerate(self.rows):
            if all(place == row[0] for place in row):
                raise DeclarationError("a row of trees goes from one place to another", "rows", number)
        return self
