"""How trees move: trunks, limbs and leaves with the frequencies that are measured of them, near and far (F3, W4)."""

from collections.abc import Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Pose, Prairie, Tree
from tallgrass.systems.trees import standing
from tallgrass.systems.trees.draw import TreePart
from tallgrass.systems.trees.standing import HUNG
from tallgrass.systems.trees.stream import CARDS
from tallgrass.testing import Stage, little_prairie, looking, private_world

SCENE = """\
tallgrass: 2
seed: 5
terrain: { noise: flat, size: [80, 80] }
grass: { turf: { height: [0.2, 0.3], width: 0.02, blades: 4 } }
trees: { oak: { habit: oak, height: [13, 13] } }
wind: [{ kind: breeze, strength: 0.6, direction: 90, gustiness: 0.0 }]
light: { azimuth: 90, elevation: 40, haze: 1e6 }
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 2, strips: 2, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 4
  carpet: 16
"""
RATE, COUNT = 25.0, 144


@pytest.fixture
def prairie(ctx: moderngl.Context) -> Iterator[Prairie]:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as made:
        esper.create_entity(Tree("oak", 13.0), Pose(0.0, 0.0))
        yield made


def twigs(prairie: Prairie) -> NDArray[np.void]:
    """What is told of the cards of its twigs just now, records of `HUNG`."""
    assert prairie.painter is not None
    kinds = vars(prairie.painter.part(TreePart))["_kinds"]
    hung = [model.hung[name] for model in kinds[0].models for name in CARDS]
    return np.concatenate(
        [np.frombuffer(each.buffer.read(each.count * HUNG.itemsize), HUNG) for each in hung if each.count]
    )


def offsets(told: NDArray[np.uint32]) -> NDArray[np.float64]:
    """How far their feet are from the eye [m], as `pack_offset` of hung.glsl packs it into two numbers (n, 2)."""
    low, high = told.T
    whole = np.stack([low, low >> 19 | high << 13, high >> 6], axis=1) & 0x7FFFF
    return np.asarray((2.0 * whole / 0x7FFFF - 1.0) * np.exp2((high >> 25).astype(np.float64) - 64.0)[:, None])


def power(of: NDArray[np.float64]) -> tuple[NDArray[np.floating[Any]], NDArray[np.floating[Any]]]:
    """Frequencies [Hz], and the part of the power that each has, of series (time, n)."""
    window = np.hanning(len(of))[:, None]
    found = (np.abs(np.fft.rfft((of - of.mean(axis=0)) * window, axis=0)) ** 2).sum(axis=1)
    return np.fft.rfftfreq(len(of), 1.0 / RATE), found / found.sum()


@pytest.mark.usefixtures("unpictured")
def test_w4_an_oak_in_a_breeze_swings_with_the_frequencies_of_trunks_limbs_and_leaves(
    ctx: moderngl.Context, prairie: Prairie
) -> None:
    """Trunks: 0.2 to 0.5 Hz (Moore and Maguire, 2004), limbs 1 to 3 (James and others, 2006), leaves 3 to 10."""
    stage = Stage(ctx, (16, 16))
    matrices = stage.matrices(looking(0.0, 1.7, 26.0, pitch=10.0, view=1.2))  # few pixels of a tall tree
    foot, axes = [], []
    for _ in range(COUNT):
        stage.begin()
        prairie.draw(*matrices)
        rows = twigs(prairie)
        told = rows["hung_place"][rows["hung_look"].any(axis=1)]
        foot.append(offsets(told[:, :2]))
        axes.append(np.stack([told[:, 2] & 0x7FF, told[:, 2] >> 11 & 0x7FF], axis=1) / 2047.0)
        prairie.advance(1.0 / RATE)
    places, along = np.stack(foot), np.stack(axes)
    assert places.shape[1] > 200
    whole = places.mean(axis=1)[:, ::2]  # the crown in the mean: limbs swing each in their own time
    hertz, share = power(whole)
    assert share[(hertz > 0.1) & (hertz < 0.75)].sum() > 0.8
    hertz, share = power((places - places.mean(axis=1, keepdims=True)).reshape(COUNT, -1))
    limbs = (hertz > 0.8) & (hertz < 3.4)
    assert share[limbs].sum() > 0.5
    assert share[hertz > 3.4].sum() < 0.05
    hertz, share = power(along.reshape(COUNT, -1))
    assert share[(hertz > 2.6) & (hertz < 11.2)].sum() > 0.9


@pytest.mark.slow
def test_w4_near_and_far_it_bends_as_far_and_swings_in_the_same_time(
    ctx: moderngl.Context, prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    stage = Stage(ctx, (96, 96))
    matrices = stage.matrices(looking(0.0, 9.0, 34.0, pitch=0.0, view=15.0))

    def middles() -> NDArray[np.float64]:
        """How far to the right the crown's upper half is, in pixels, at some instants."""
        found = []
        for _ in range(28):
            stage.begin()
            prairie.draw(*matrices)
            blue = stage.read()[:48, :, 2]
            hides = np.clip(blue.max() - blue, 0.0, 100.0)
            found.append((hides * np.arange(96)).sum() / hides.sum())
            prairie.advance(0.25)
        return np.convolve(found, np.full(4, 0.25), "valid")  # limbs, which swing once a second, are left out

    monkeypatch.setattr(standing, "FEWEST_TWIGS", 0.25)  # of a tree that is high enough for twigs
    seen = []
    for gone in (1.0, 1e5):
        monkeypatch.setattr(standing, "PICTURE_BELOW", gone)
        monkeypatch.setattr(standing, "FADES_BELOW", 2.0 * gone)
        esper.delete_entity(next(entity for entity, _ in esper.get_component(Tree)), immediate=True)
        esper.create_entity(Tree("oak", 13.0), Pose(0.0, 0.0))
        prairie.time = 114.0
        seen.append(middles())
    near, far = seen
    assert near.std() > 0.15
    assert np.corrcoef(near, far)[0, 1] > 0.8
    assert far.std() == pytest.approx(near.std(), rel=0.3)
    assert far.mean() == pytest.approx(near.mean(), abs=3.0)
