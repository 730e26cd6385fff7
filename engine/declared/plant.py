"""Plants: what a kind may be, what its heads are like, and what goes without saying of each."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from ...components.declaration import Color, Declaration, Pair, rising

Plant = Literal["grass", "flower", "forb", "shrub"]
"""The kinds of plant that there are."""

HeadForm = Literal["disc", "bell", "spike", "umbel", "plume"]

ON_GRASS: tuple[HeadForm, ...] = ("spike", "plume")
"""The forms of heads that grasses have."""

WITH_EYES: tuple[HeadForm, ...] = ("disc", "bell")
"""The forms of heads that may have an eye."""

SIZES: Mapping[HeadForm, tuple[float, float]] = {
    "disc": (0.035, 0.05),
    "bell": (0.03, 0.045),
    "spike": (0.08, 0.14),
    "umbel": (0.08, 0.13),
    "plume": (0.15, 0.25),
}
"""Sizes of heads that do not say [m]."""

PETALS: Mapping[HeadForm, int] = {"disc": 12, "bell": 6, "spike": 9, "umbel": 18, "plume": 16}
"""Petals of heads that do not say."""

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
"""By plant: what it is where a scene does not say; of grass the fields say it themselves."""


class Head(Declaration):
    """What a plant's stems or branches bear: petals, florets, or seeds, of the kind's colour `tip`."""

    form: HeadForm = "disc"
    """Petals spread out, or standing as a bell; florets along the top of the stem, or on rays from one point; or the
    tufts of a plume. Grass bears spikes and plumes alone."""

    size: Annotated[Pair, rising("size must be [smallest, largest]", 0.005, 2.0)] | None = None
    """Smallest and largest: the width of an open disc, bell or umbel, the length of a spike or plume [m]; without it,
    what suits the form."""

    petals: int | None = Field(default=None, ge=3, le=48)
    """Petals, rays or tufts, or rows of florets, at 500 blades a patch; coarser qualities have fewer and broader
    ones. Without it, what suits the form."""

    open: float = Field(default=0.85, ge=0.0, le=1.0)
    """Share of the heads that are open; of the others, some are in bud and some have set seed.
    Spikes open from below."""

    eye: Color | None = None
    """Colour of its eye, the middle third of a disc or bell: of stamens and the foot of the petals, as of a poppy, or
    with nine petals or more of a disc of florets, as of a daisy. Without it, it is of the plant's own colours."""

    share: float = Field(default=1.0, gt=0.0, le=1.0)
    """Share of the plants that bear a head."""
