"""The paper's three presets have the paper's numbers (R1)."""

import re
from collections.abc import Callable, Iterator
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import moderngl
import pytest

from tallgrass.components.arrays import Doubles
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.systems.grow.raster import Fragments, rasterise
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.carpet import grow as carpet_grow
from tallgrass.systems.show.strips import grow as strips_grow
from tallgrass.systems.stock.models import precompute_bytes
from tallgrass.testing import Stage

Seen = Callable[[str, str], dict[str, int]]

PAPER = {
    "paper-low": (160, (3, 8), 3, 100_000),
    "paper-medium": (320, (2, 12), 4, 500_000),
    "paper-high": (500, (3, 20), 8, 1_000_000),
}
"""Blades per patch, the distances of the 2.5D strips, segments per blade, about how many blades in the image."""


PAGE = (Path(__file__).parents[2] / "docs" / "performance.md").read_text("utf-8")


def wide_plain() -> str:
    """Path of the scene `plain` on 170 m, as in the manual's page on performance."""
    plain = (files("tallgrass.scenes") / "plain.yaml").read_text("utf-8")
    wide = plain.replace("size: [100, 100]", "size: [170, 170]")
    assert wide != plain, "1600 patches of 500 blades are no million"
    return wide


def rows(told: str) -> dict[str, dict[str, str]]:
    """Return the first table of a text: for each first cell its row, as cells by column."""
    table = re.search(r"(?:^\|.*\|\n)+", told, re.MULTILINE)
    assert table
    first, _, *others = (line.strip("| ").split(" | ") for line in table[0].splitlines())
    return {cells[0].strip("`"): dict(zip(first, cells, strict=True)) for cells in others}


@pytest.fixture(scope="module")
def _hardly_painted(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Paint a few blades only into pictures of grass: sizes are the same, and counts need no more."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TALLGRASS_CACHE", str(tmp_path_factory.mktemp("grown")))  # nobody else is to be given these
        for module in (carpet_grow, strips_grow):
            patch.setattr(module, "rasterise", few_painted)
        yield


def few_painted(corners: Doubles, nearness: Doubles, /, **options: Any) -> Fragments:
    return rasterise(corners[:20], nearness[:20], **options)


@pytest.fixture(scope="module")
def seen(_hardly_painted: None, ctx: moderngl.Context, stage: Stage, tmp_path_factory: pytest.TempPathFactory) -> Seen:
    """Return the function that draws a scene in a preset once, and returns its counts: `seen(scene, preset)`."""
    folder = tmp_path_factory.mktemp("scenes")

    @cache
    def told(scene: str, preset: str) -> dict[str, int]:
        path = folder / "wide.yaml"
        path.write_text(wide_plain(), "utf-8")
        prairie = Prairie.load(path if scene == "wide plain" else scene, ctx=ctx, preset=preset)
        stage.shot(prairie)
        stage.shot(prairie)  # the first alone has a call more, for the terrain's shadows
        counts = counted(prairie)
        prairie.release()
        return counts

    return told


def counted(prairie: Prairie) -> dict[str, int]:
    """Return the counts of a picture in the manual's words, and the memory of its growths [MB]."""
    seen = prairie.statistics
    return {
        "blades in the field": seen.blades_field,
        "in view": seen.blades_considered,
        "drawn as ribbons": seen.blades_submitted,
        "receivers": seen.receivers,
        "draw calls": seen.draw_calls,
        "grown": round(sum(map(precompute_bytes, prairie.site.growths)) / 1e6),
    }


@pytest.mark.parametrize(
    ("scene", "before", "presets"),
    [
        pytest.param("meadow", "## What it takes here", ("low", "medium", "high"), marks=pytest.mark.slow),
        pytest.param("wide plain", "## The paper's instances", tuple(PAPER), marks=pytest.mark.slow),
        ("plain", "on the bundled 100 m", tuple(PAPER)),
    ],
    ids=["meadow", "wide plain", "plain"],
)
def test_the_page_of_performance_counts_what_is_drawn(
    scene: str, before: str, presets: tuple[str, ...], seen: Seen
) -> None:
    table = rows(PAGE.partition(before)[2])
    for preset in presets:
        counts = {head: f"{count:,}{' MB' * (head == 'grown')}" for head, count in seen(scene, preset).items()}
        told = {head: cell for head, cell in table[preset].items() if head in counts}
        assert len(told) >= 2
        assert told == {head: counts[head] for head in told}, preset


@pytest.mark.parametrize("preset", PAPER)
def test_r1_a_paper_preset_has_the_numbers_of_the_papers_table(preset: str) -> None:
    blades, (nearest, farthest), segments, _ = PAPER[preset]
    quality = PRESETS[preset]
    assert quality.patch == 2.5
    assert quality.blades == blades
    assert [(ring.to, ring.segments) for ring in quality.blade_rings] == [(nearest - 1, segments)]
    assert [ring.to for ring in quality.strip_rings] == [farthest]


@pytest.mark.parametrize("preset", PAPER)
def test_r1_the_image_of_a_wide_enough_plain_has_the_papers_number_of_blades(preset: str, seen: Seen) -> None:
    assert seen("wide plain", preset)["in view"] == pytest.approx(PAPER[preset][3], rel=0.15)


@pytest.mark.parametrize(("own", "farther"), [("low", 4), ("medium", 4), ("high", 0)])
def test_r1_the_presets_that_people_use_have_the_papers_blades_and_their_strips_end_where_it_says_or_farther(
    own: str, farther: int
) -> None:
    ours, theirs = PRESETS[own], PRESETS[f"paper-{own}"]
    assert (ours.patch, ours.blades) == (theirs.patch, theirs.blades)
    assert ours.blade_rings[0].segments == theirs.blade_rings[0].segments
    assert ours.strip_rings[-1].to == theirs.strip_rings[-1].to + farther
