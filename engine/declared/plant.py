"""Plants: their kinds, their heads, and the defaults of each."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from ...components.declaration import Color, Declaration, Pair, rising

Plant = Literal["grass", "flower", "forb", "shrub"]
"""Kinds of plant."""

HeadForm = Literal["disc", "bell", "spike", "umbel", "plume"]

ON_GRASS: tuple[HeadForm, ...] = ("spike", "plume")
"""Forms of heads for grass."""

WITH_EYES: tuple[HeadForm, ...] = ("disc", "bell")
"""Forms of heads that may have an eye."""

SIZES: Mapping[HeadForm, tuple[float, float]] = {
    "disc": (0.035, 0.05),
    "bell": (0.03, 0.045),
    "spike": (0.08, 0.14),
    "umbel": (0.08, 0.13),
    "plume": (0.15, 0.25),
}
"""Default sizes of heads, smallest and largest [m]."""

PETALS: Mapping[HeadForm, int] = {"disc": 12, "bell": 6, "spike": 9, "umbel": 18, "plume": 16}
"""Default numbers of petals."""

FLOWER: Mapping[str, Any] = {
    "height": [0.22, 0.42], "width": 0.02, "lean": 0.2, "stiffness": 1.2, "clumping": 0.3, "root": "#50692d",
    "tip": "#f4ce23", "variety": 0.2, "gloss": 0.02, "understorey": 0.0, "head": {},
}  # fmt: skip
FORB: Mapping[str, Any] = {
    "height": [0.25, 0.5], "width": 0.05, "lean": 0.2, "stiffness": 1.2, "root": "#3b5826", "tip": "#86a64b",
    "gloss": 0.04, "understorey": 0.0,
}  # fmt: skip
SHRUB: Mapping[str, Any] = {
    "height": [0.3, 0.5], "width": 0.014, "lean": 0.55, "stiffness": 2.0, "root": "#46522c", "tip": "#87984f",
    "gloss": 0.02, "understorey": 0.9,
}  # fmt: skip
USUAL: Mapping[str, Mapping[str, Any]] = {"flower": FLOWER, "forb": FORB, "shrub": SHRUB}
"""Defaults by plant; those of grass are in the fields themselves."""


class Head(Declaration):
    """The head on a plant's stems or branches: petals, florets, or seeds, of the kind's colour `tip`."""

    form: HeadForm = "disc"
    """Form: petals spread out, or standing as a bell; florets along the top of the stem, or on rays from one point; or
    the tufts of a plume. Grass bears spikes and plumes alone."""

    size: Annotated[Pair, rising("size must be [smallest, largest]", 0.005, 2.0)] | None = None
    """Smallest and largest width of an open disc, bell or umbel, or length of a spike or plume [m]; without it, what
    suits the form."""

    petals: int | None = Field(default=None, ge=3, le=48)
    """Number of petals, rays or tufts, or rows of florets, at 500 blades a patch; coarser qualities have fewer and
    broader ones. Without it, what suits the form."""

    open: float = Field(default=0.85, ge=0.0, le=1.0)
    """Fraction of the heads that are open; of the others, some are in bud and some have set seed.
    Spikes open from below."""

    eye: Color | None = None
    """Colour of its eye, the middle third of a disc or bell: stamens and the foot of the petals, as in a poppy, or with
    nine petals or more a disc of florets, as in a daisy. Without it, the eye has the plant's own colours."""

    share: float = Field(default=1.0, gt=0.0, le=1.0)
    """Fraction of the plants that bear a head."""
