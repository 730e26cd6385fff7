"""Trees and bushes, as a scene declares them."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from ...components.declaration import Color, Declaration, DeclarationError, Pair, rising
from ...components.tree import HIGHEST, LOWEST

HabitName = Literal["oak", "birch", "pine", "poplar", "willow", "hawthorn"]

MOST = 20_000
"""Greatest number of trees of a kind in a scene."""

COLOURS = "leaf", "bark", "variety"
"""Keys that may change without planting the trees anew."""


class TreeKind(Declaration):
    """A kind of tree or bush: its growth and its places.

    Trees stand at `positions`, along `rows`, and by `density`. Where two would stand too near, the later one is left
    out; those of `density` come last.
    """

    habit: HabitName
    """Habit of growth: of an oak, birch, pine, poplar, willow or hawthorn, the last of which is a bush."""

    height: Annotated[Pair, rising("height must be [lowest, highest]", LOWEST, HIGHEST)] | None = None
    """Lowest and highest grown tree [m]; without it, what suits the habit."""

    foliage: float = Field(default=1.0, gt=0.0, le=1.0)
    """Fraction of its leaves that it has: fewer in autumn, or where it ails."""

    leaf: Color | None = None
    """Colour of leaves in the sun; without it, what suits the habit."""

    bark: Color | None = None
    """Colour of bark; without it, what suits the habit."""

    variety: float = Field(default=0.12, ge=0.0, le=0.6)
    """Variation of brightness and hue among trees, as a fraction."""

    young: float = Field(default=0.3, ge=0.0, le=1.0)
    """Fraction of the trees of `density` that still grow: they are of all ages, and so of all heights."""

    positions: list[Pair] = Field(default=[], max_length=MOST)
    """Ground positions (x, z) of single trees [m]; none grow over holes of the terrain."""

    rows: list[Annotated[list[Pair], Field(min_length=2, max_length=1000)]] = Field(default=[], max_length=1000)
    """Lines of ground positions (x, z) [m] with trees along them, `spacing` apart: avenues and hedges, as far as there
    is ground."""

    spacing: float = Field(default=6.0, ge=0.3, le=1000.0)
    """Distance from tree to tree in a row, and the least distance among those of `density` [m]."""

    uneven: float = Field(default=0.0, ge=0.0, le=1.0)
    """Unevenness of rows: with 1, some trees are as far from their places by `spacing` as the next tree's place, and
    one in eight is missing."""

    density: float = Field(default=0.0, ge=0.0, le=5000.0)
    """Number of further trees per hectare, as far as there is room."""

    groves: float = Field(default=0.0, ge=0.0, le=1.0)
    """Grouping of trees of `density`: 0 spreads them evenly, 1 leaves open ground between dense groves."""

    among: str | None = None
    """Name of a kind of grass: trees of `density` stand where its map has it. Without it, everywhere."""

    slope: float = Field(default=40.0, ge=0.0, le=90.0)
    """Steepest slope that trees of `density` stand on [degrees]."""

    @property
    def uncoloured(self) -> "TreeKind":
        """The kind with default colours, for comparing places and heights alone."""
        return self.model_copy(update={name: type(self).model_fields[name].default for name in COLOURS})

    @model_validator(mode="after")
    def _stands_apart(self) -> "TreeKind":
        for number, row in enumerate(self.rows):
            if all(place == row[0] for place in row):
                raise DeclarationError("a row of trees goes from one place to another", "rows", number)
        return self
