"""The list of features, and the texture units of all samplers."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

from ..engine.gl.units import UNITS as FREE
from .bodies.feature import Bodies
from .frame.feature import Feature
from .lamps.feature import Lamps
from .land.earth import Earth
from .land.part import Land
from .light.feature import Lighting
from .light.given import GivenHaze
from .mow.feature import Mowing
from .pressers import Pressers
from .shadows.feature import UNITS as BORROWED
from .shadows.feature import Shadows
from .show.registry import REPRESENTATIONS
from .trees.feature import Trees
from .trees.shade import UNIT as TREE_SHADE
from .winds import Winds

FEATURES: tuple[type[Feature], ...] = (
    Winds, Pressers, Land, Earth, Lighting, GivenHaze, Mowing, Lamps, Shadows, Bodies, Trees,
)  # fmt: skip
"""All features, in the order in which they are made, take over a scene read again, and are drawn."""

STAGE = len(FREE)
"""Minimum number of texture units of a shader stage in OpenGL 3.3; no program uses more in all stages together."""


def assign_units(
    throughout: Sequence[str], asked: Sequence[str], own: Mapping[str, tuple[Iterable[str], Iterable[str]]], /
) -> dict[str, int]:
    """Return the texture unit of each sampler, one of `FREE`.

    Samplers bound `throughout` a frame have the first units. Next come the samplers of each owner in `own`: those of
    its passes over receivers, then those of its drawing. Each owner binds its own when it draws, so all owners share
    these units. The samplers that any pass over receivers reads, `asked`, have the last units. Raises RuntimeError if a
    program would need more than `STAGE`.
    """
    units = dict(zip(throughout, FREE, strict=False))
    units |= dict(zip(asked, reversed(FREE), strict=False))
    for owner, (passed, drawn) in own.items():
        first = list(dict.fromkeys(passed))
        names = [*first, *(name for name in drawn if name not in first)]
        for needed in ([*throughout, *first, *asked], [*throughout, *names]):
            if len(needed) > STAGE:
                raise RuntimeError(
                    f"{owner} reads {len(needed)} textures at once where OpenGL 3.3 has {STAGE}: {', '.join(needed)}"
                )
        units |= dict(zip(names, FREE[len(throughout) :], strict=False))
    return units


UNITS = (
    assign_units(
        ["received", *(name for each in FEATURES for name in each.samplers)],
        [name for each in FEATURES for name in each.pass_samplers],
        {
            **{each.__name__: ((), each.own) for each in FEATURES},
            **{each.name: (each.pass_samplers, each.samplers) for each in REPRESENTATIONS},
        },
    )
    | BORROWED
    | {"tree_shade": TREE_SHADE}
)
"""Texture unit of each sampler."""

OneFeature = TypeVar("OneFeature", bound=Feature)


def feature_of(kind: type[OneFeature], features: Iterable[Feature], /) -> OneFeature:
    """Return the feature of a class."""
    return next(feature for feature in features if isinstance(feature, kind))
