"""Texture units: which one each sampler reads from."""

from collections.abc import Iterable, Mapping, Sequence

from ...engine.gl.units import UNITS

STAGE = len(UNITS)
"""Units that a shader stage has at least, in OpenGL 3.3: all programs make do with so many, in all stages."""


def dealt(
    throughout: Sequence[str], asked: Sequence[str], own: Mapping[str, tuple[Iterable[str], Iterable[str]]], /
) -> dict[str, int]:
    """Return the texture unit of each sampler, one of `UNITS`.

    What is bound `throughout` a frame comes first. After it comes what each of `own` has, by its name, what its passes
    over receivers read and then all else: each binds them itself when it draws, so all share these units. What any pass
    over receivers reads, `asked`, comes last. Raises RuntimeError where a program would need more than `STAGE`.
    """
    units = dict(zip(throughout, UNITS, strict=False))
    units |= dict(zip(asked, reversed(UNITS), strict=False))
    for who, (passed, drawn) in own.items():
        first, rest = list(dict.fromkeys(passed)), list(drawn)
        names = [*first, *(name for name in rest if name not in first)]
        for needed in ([*throughout, *first, *asked], [*throughout, *names]):
            if len(needed) > STAGE:
                raise RuntimeError(
                    f"{who} reads {len(needed)} textures at once where OpenGL 3.3 has {STAGE}: {', '.join(needed)}"
                )
        units |= dict(zip(names, UNITS[len(throughout) :], strict=False))
    return units
