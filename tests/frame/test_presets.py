"""The paper's three presets have the paper's numbers (R1)."""

from collections.abc import Callable
from importlib.resources import files

import pytest

from tallgrass.engine.declared.quality import PRESETS
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Stage

Load = Callable[..., Prairie]

PAPER = {
    "paper-low": (160, (3, 8), 3, 100_000),
    "paper-medium": (320, (2, 12), 4, 500_000),
    "paper-high": (500, (3, 20), 8, 1_000_000),
}
"""Blades per patch, the distances of the 2.5D strips, segments per blade, about how many blades in the image."""


@pytest.mark.parametrize("preset", PAPER)
def test_r1_a_paper_preset_has_the_numbers_of_the_papers_table(preset: str) -> None:
    blades, (nearest, farthest), segments, _ = PAPER[preset]
    quality = PRESETS[preset]
    assert quality.patch == 2.5
    assert quality.blades == blades
    assert [(ring.to, ring.segments) for ring in quality.blade_rings] == [(nearest - 1, segments)]
    assert [ring.to for ring in quality.strip_rings] == [farthest]


@pytest.mark.parametrize("preset", PAPER)
def test_r1_the_image_of_a_wide_enough_plain_has_the_papers_number_of_blades(
    preset: str, load: Load, stage: Stage
) -> None:
    plain = (files("tallgrass.scenes") / "plain.yaml").read_text("utf-8")
    wide = plain.replace("size: [100, 100]", "size: [170, 170]")
    assert wide != plain, "1600 patches of 500 blades are no million"
    prairie = load(wide, preset=preset)
    stage.shot(prairie)
    assert prairie.statistics.blades_considered == pytest.approx(PAPER[preset][3], rel=0.15)


@pytest.mark.parametrize(("own", "paper"), [("low", "paper-low"), ("medium", "paper-medium"), ("high", "paper-high")])
def test_r1_the_presets_that_people_use_have_the_papers_blades_segments_and_far_ends(own: str, paper: str) -> None:
    ours, theirs = PRESETS[own], PRESETS[paper]
    assert (ours.patch, ours.blades) == (theirs.patch, theirs.blades)
    assert ours.blade_rings[0].segments == theirs.blade_rings[0].segments
    assert ours.strip_rings[-1].to == theirs.strip_rings[-1].to
