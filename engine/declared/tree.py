"""Trees and bushes: what a scene declares of them."""

from typing import Annotated, Literal, get_args

from pydantic import Field, model_validator

from ...components.declaration import Color, Declaration, DeclarationError, Pair, rising

HabitName = Literal["oak", "birch", "pine", "poplar", "willow", "hawthorn"]

HABITS: tuple[HabitName, ...] = get_args(HabitName)

LOWEST, HIGHEST = 0.5, 60.0
"""How high a tree may be at least and at most [m]: of the sorts that there are, none grows higher."""

MOST = 20_000
"""Trees of a kind in a scene at most."""


class TreeKind(Declaration):
    """A kind of tree or bush: how it grows, and where.

    It stands at the `positions` that are written, along `rows`, and where its `density` brings it. Where it stands too
    near to another tree, the later one is left out.
    """

    habit: HabitName
    """How it grows: as an oak, birch, pine, poplar, willow or hawthorn, the last of which is a bush."""

    height: Annotated[Pair, rising("height must be [lowest, highest]", LOWEST, HIGHEST)] | None = None
    """Lowest and highest tree [m]; without it, what suits the habit."""

    foliage: float = Field(default=1.0, gt=0.0, le=1.0)
    """How many of its leaves it has: less is an autumn's or an ailing tree's."""

    leaf: Color | None = None
    """Colour of leaves in the sun; without it, what suits the habit."""

    bark: Color | None = None
    """Colour of bark; without it, what suits the habit."""

    variety: float = Field(default=0.12, ge=0.0, le=0.6)
    """How far trees differ in brightness and hue from one another, as a fraction."""

    positions: list[Pair] = Field(default=[], max_length=MOST)
    """Where single ones stand, ground positions (x, z) [m]."""

    rows: list[Annotated[list[Pair], Field(min_length=2, max_length=1000)]] = Field(default=[], max_length=1000)
    """Lines of ground positions (x, z) [m] along which they stand, `spacing` apart: avenues and hedges."""

    spacing: float = Field(default=6.0, ge=0.3, le=1000.0)
    """How far one stands from the next in a row, and at least among those that `density` brings [m]."""

    density: float = Field(default=0.0, ge=0.0, le=5000.0)
    """How many more grow on a hectare, as many as there is room for."""

    groves: float = Field(default=0.0, ge=0.0, le=1.0)
    """How much those stand together in groves: 0 is all over, 1 leaves open ground between dense groves."""

    among: str | None = None
    """Name of a kind of grass: those grow as densely as its map has it; without it, everywhere."""

    slope: float = Field(default=40.0, ge=0.0, le=90.0)
    """Steepest slope that those grow on [degrees]."""

    @model_validator(mode="after")
    def _stands_apart(self) -> "TreeKind":
        for number, row in enumerate(self.rows):
            if all(place == row[0] for place in row):
                raise DeclarationError("a row of trees goes from one place to another", "rows", number)
        return self
