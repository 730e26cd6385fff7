"""`tallgrass bench picture`: the fidelity of a picture to every blade in 3D, supersampled."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...engine.camera import View, view_of
from ...engine.declared.quality import Quality
from ...systems.light.color import luminance
from ...systems.reference import (
    EveryBlade,
    Truth,
    cells_within,
    draw_truth,
    patch_distances,
    without_trees,
)
from ...systems.show.registry import NAMES
from ..studio.encode import Picture, picture_writer
from ..studio.progress import Bar, course
from ..studio.studio import Studio, about
from ..studio.take import SAMPLES, Take
from .contrast import contrast
from .flip import MOMENT, evaluator, flip, hue_between, mean_light
from .machine import head
from .many import Survey
from .multisampled import Multisampled
from .trees import Behind, tree_figures

OTHER_SEED = 7919
"""Offset of the scene's seed that gives unrelated grass of the same look."""

PARTS = {"every blade": 3.0, "the reference": 4.0, "unrelated grass": 6.0}
"""Names of the steps, with their approximate relative durations."""

FEWEST = 400
"""Least number of pixels in a band that is reported."""


@dataclass(frozen=True, slots=True, eq=False)
class Pictures:
    """One view at one instant, drawn in several ways."""

    lod: Picture
    all_3d: Picture

    msaa: Picture | None
    """Every blade with several samples a pixel; None where the driver has too few."""

    truth: Truth
    other_seed: Picture
    distance: NDArray[np.int32]
    """Discrete distance of what each pixel shows, -1 for the sky, shape (height, width)."""

    behind: Behind | None = None
    """Background of the trees; None in a scene without trees."""


def measured(take: Take, output: str | None = None, /) -> dict[str, Any]:
    """Return the benchmark's figures of a scene; write its picture beside the reference into the folder `output`."""
    with course("a picture", PARTS) as way, Studio(take) as studio:
        pictures = _draw(studio, way)
        common = head(studio.ctx, studio.prairie, take) | {"frames": 1}
        if output is not None:
            beside = np.concatenate([pictures.lod, pictures.truth.picture], axis=1)
            name = str(Path(output) / f"{Path(take.scene).stem}.png")
            picture_writer(name)(beside, about(studio.prairie.scene, take, time=studio.prairie.time))
        return common | compare(pictures, studio.prairie.site.quality)


def _draw(studio: Studio, way: Bar) -> Pictures:
    prairie, size = studio.prairie, studio.take.size
    prairie.advance(MOMENT)
    view, projection = studio.matrices(studio.camera(None))
    with way.part("every blade"):
        studio.begin()
        prairie.draw(view, projection)
        lod = studio.read()
        all_3d, msaa = _every_blade(studio, view_of(view, projection))
    with way.part("the reference"):
        truth = draw_truth(prairie, view, projection, size, samples=SAMPLES)
        distance = patch_distances(prairie, view, projection, size)
        behind = _behind(studio, view, projection, distance) if prairie.scene.trees else None
    with way.part("unrelated grass"):
        other = prairie.reseeded(prairie.scene.seed + OTHER_SEED)
        other.advance(MOMENT)
        studio.begin()
        other.draw(view, projection)
        unrelated = draw_truth(other, view, projection, size, samples=SAMPLES).picture
        other.release()
    return Pictures(lod, all_3d, msaa, truth, unrelated, distance, behind)


def _behind(studio: Studio, view: object, projection: object, distance: NDArray[np.int32]) -> Behind:
    """Return the background of trees in a picture; `distance` (height, width) is the discrete distance with trees."""
    with without_trees(studio.prairie):
        studio.begin()
        studio.prairie.draw(view, projection)
        bare = studio.read()
        beyond = patch_distances(studio.prairie, view, projection, studio.take.size)
    return Behind(bare, beyond < 0, distance != beyond)


def _every_blade(studio: Studio, view: View) -> tuple[Picture, Picture | None]:
    """Return pictures of every blade with one sample a pixel, and with several or None where the driver has too few."""
    prairie, every = studio.prairie, EveryBlade(studio.prairie)
    viewer = every.outlook.viewer
    cells = cells_within(prairie.site.ground, viewer.eye, viewer.cone, sway=prairie.site.sway)
    studio.begin()
    target = studio.ctx.detect_framebuffer()
    every.draw(view, cells)
    all_3d = studio.read()
    fine = Multisampled(studio.ctx, studio.take.size)
    fine.begin()
    every.draw(view, cells)
    fine.resolve(target)
    msaa = studio.read() if fine.smooth else None
    every.release()
    fine.release()
    return all_3d, msaa


def compare(pictures: Pictures, quality: Quality) -> dict[str, object]:
    """Return the benchmark's figures: FLIP of each picture, the scores, the contrast, and the bands."""
    flips = {
        name: flip(picture, pictures.truth.picture)
        for name in ("lod", "all_3d", "msaa", "other_seed")
        if (picture := getattr(pictures, name)) is not None
    }
    kept = contrast(pictures.lod, pictures.truth, pictures.distance >= 0)
    return {
        "flip": {"msaa": None} | {name: round(value, 5) for name, value in flips.items()},
        "score": score(flips, "all_3d"),
        "score_msaa": score(flips, "msaa"),
        "contrast": None if kept is None else round(kept, 4),
        "bands": bands(pictures.lod, pictures.truth.picture, pictures.distance, quality),
        "trees": None if pictures.behind is None else tree_figures(pictures.lod, pictures.truth, pictures.behind),
    }


def score(flips: Mapping[str, float], rival: str, /) -> float | None:
    """Return the position of `lod` between its rival and unrelated grass, by their FLIP against the reference.

    0: the levels of detail are as true as the rival. 1: they are as far off as unrelated grass. In pictures so small
    that the rival is farther off than unrelated grass, the sign still says whether `lod` or the rival is truer. None
    without a rival, or where rival and unrelated grass are equally far off.
    """
    span = abs(flips["other_seed"] - flips.get(rival, flips["other_seed"]))
    return round((flips["lod"] - flips[rival]) / span, 4) if span else None


def bands(
    picture: Picture, reference: Picture, distance: NDArray[np.int32], quality: Quality
) -> list[dict[str, object]]:
    """Return luminance ratio and hue difference of each band of distance, against the reference.

    `distance` (height, width) is the discrete distance of what each pixel shows, -1 for the sky. A band's
    colour is the mean of its pixels in display space, as for all averages of pixels. Its luminance and hue are taken
    from the linear light of that colour.
    """
    edges = [ring.to for ring in quality.blade_rings] + [ring.to for ring in quality.strip_rings]
    edges += [quality.carpet_to, int(distance.max())]
    rows: list[dict[str, object]] = []
    start = 0
    for number, end in enumerate(edges):
        inside = (distance >= start) & (distance <= end)
        if inside.sum() >= FEWEST:
            drawn, true = (mean_light(each, inside) for each in (picture, reference))
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


def _cells(result: dict[str, Any]) -> dict[str, object]:
    """Return the table's cells for a scene; of its bands, the worst luminance ratio and hue difference."""
    ratios = [band["luminance_ratio"] for band in result["bands"]]
    return {
        "luminance": max(ratios, key=lambda ratio: abs(ratio - 1.0), default=None),
        "hue": max((band["hue_degrees"] for band in result["bands"]), default=None),
        "contrast": result["contrast"],
        "flip": result["flip"]["lod"],
        "flip_msaa": result["flip"]["msaa"],
        "score": result["score"],
        "score_msaa": result["score_msaa"],
    }


SURVEY = Survey(measured, "drawing every blade", _cells, kept=("bands", "trees"), need=evaluator)
"""The benchmark for many scenes."""
