"""`tallgrass bench picture`: how true a picture is to every blade in 3D, supersampled."""

import importlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...engine.camera import view_of
from ...engine.declared.quality import Quality
from ...systems.frame.light import decoded
from ...systems.reference import EveryBlade, draw_reference, patch_distances, seen_cells
from ...systems.show.registry import NAMES
from ..studio.encode import Picture
from ..studio.errors import MachineError
from ..studio.progress import busy
from ..studio.studio import Studio
from ..studio.take import SAMPLES, Take
from .frame import own_preset
from .machine import machine, tell

MOMENT = 2.0
"""Instant of the picture [s]."""

OTHER_SEED = 7919
"""Added to the scene's seed for unrelated grass of the same look."""

FEWEST = 400
"""Pixels that a band must have to be told of."""


@dataclass(frozen=True, slots=True, eq=False)
class Pictures:
    """The same view at the same instant, four times, and what each pixel shows."""

    lod: Picture
    all_3d: Picture
    reference: Picture
    other_seed: Picture
    distance: NDArray[np.int32]
    """Discrete distance, -1 for the sky, shape (height, width)."""


def bench_picture(scene: str, *, preset: str | None, size: tuple[int, int], json: bool) -> int:
    """Compare a scene's picture with its reference, print the figures, and return the exit status.

    Raises MachineError, before anything is drawn, where pictures cannot be compared.
    """
    evaluator()
    take = Take(scene, size, preset=preset)
    with busy("drawing every blade"):
        with Studio(take) as studio:
            pictures = _draw(studio)
            head = {"machine": machine(studio.ctx), "scene": scene, "preset": preset or own_preset(studio.prairie)}
            quality = studio.prairie.site.quality
        result = {**head, "size": list(size), "frames": 1, **compare(pictures, quality)}
    tell(result, as_json=json)
    return 0


def _draw(studio: Studio) -> Pictures:
    prairie, size = studio.prairie, studio.take.size
    prairie.advance(MOMENT)
    view, projection = studio.matrices(studio.camera(None))
    studio.begin()
    prairie.draw(view, projection)
    lod = studio.read()
    every = EveryBlade(prairie)
    studio.begin()
    every.draw(view_of(view, projection), seen_cells(prairie.site.ground, every.outlook.viewer, sway=prairie.site.sway))
    all_3d = studio.read()
    every.release()
    reference = draw_reference(prairie, view, projection, size, samples=SAMPLES)
    distance = patch_distances(prairie, view, projection, size)
    other = prairie.reseeded(prairie.scene.seed + OTHER_SEED)
    other.advance(MOMENT)
    studio.begin()
    other.draw(view, projection)
    unrelated = draw_reference(other, view, projection, size, samples=SAMPLES)
    other.release()
    return Pictures(lod, all_3d, reference, unrelated, distance)


def compare(pictures: Pictures, quality: Quality) -> dict[str, object]:
    """Return the benchmark's figures: FLIP of each picture, the score, and the bands.

    The score is 0 where the levels of detail are as true as every blade and 1 where they are as far off as unrelated
    grass. In pictures so small that every blade, not supersampled, is farther off than that, its sign still tells
    which of the two is truer.
    """
    flips = {name: flip(getattr(pictures, name), pictures.reference) for name in ("lod", "all_3d", "other_seed")}
    span = abs(flips["other_seed"] - flips["all_3d"])
    return {
        "flip": {name: round(value, 5) for name, value in flips.items()},
        "score": round((flips["lod"] - flips["all_3d"]) / span, 4) if span else None,
        "bands": bands(pictures, quality),
    }


def flip(picture: Picture, reference: Picture) -> float:
    """Return the mean FLIP of a picture against a reference, both (height, width, 3) sRGB bytes."""
    _, mean, _ = evaluator().evaluate(
        reference.astype(np.float32) / 255.0, picture.astype(np.float32) / 255.0, "LDR", applyMagma=False
    )
    return float(mean)


def evaluator() -> Any:
    """Return the module that computes FLIP; raises MachineError where it is not installed."""
    try:
        return importlib.import_module("flip_evaluator")
    except ImportError:
        raise MachineError("pictures are compared by flip-evaluator: pip install 'tallgrass[bench]'") from None


def bands(pictures: Pictures, quality: Quality) -> list[dict[str, object]]:
    """Return how brightness and hue of each ring of distance compare with the reference's.

    A band's colour is the mean of its pixels in display space, where all averages of pixels are taken; its luminance
    and hue are those of the linear light of that colour.
    """
    edges = [ring.to for ring in quality.blade_rings] + [ring.to for ring in quality.strip_rings]
    edges += [quality.carpet_to, int(pictures.distance.max())]
    rows: list[dict[str, object]] = []
    start = 0
    for number, end in enumerate(edges):
        inside = (pictures.distance >= start) & (pictures.distance <= end)
        if inside.sum() >= FEWEST:
            drawn, true = (decoded(each[inside].mean(axis=0) / 255.0) for each in (pictures.lod, pictures.reference))
            rows.append({
                "distance": [start, end],
                "representation": _representation(number, quality),
                "luminance_ratio": round(float(luminance(drawn) / luminance(true)), 4),
                "hue_degrees": round(hue_between(drawn, true), 2),
            })  # fmt: skip
        start = end + 1
    return rows


def _representation(number: int, quality: Quality) -> str:
    blades, strips = len(quality.blade_rings), len(quality.strip_rings)
    return NAMES[(number >= blades) + (number >= blades + strips)]


def luminance(light: NDArray[np.float64]) -> float:
    """Return the relative luminance of linear light (3,)."""
    return float(light @ np.array([0.2126, 0.7152, 0.0722]))


def hue_between(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Return the angle between the hues of two linear colours (3,), in [0, 180] degrees."""
    angles = [np.degrees(np.arctan2(np.sqrt(3.0) * (g - bl), 2.0 * r - g - bl)) for r, g, bl in (a, b)]
    return float(abs((angles[0] - angles[1] + 180.0) % 360.0 - 180.0))
