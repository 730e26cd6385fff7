"""Plants other than grass: the rows that stand on one root."""

from collections.abc import Iterator
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.plant import Head
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.systems.grow import organs
from tallgrass.systems.grow.bend import spine, tone, widths
from tallgrass.systems.grow.blades import grow_blades, let_hang
from tallgrass.systems.grow.layout import layout_of
from tallgrass.systems.grow.plants import grow_patch
from tallgrass.systems.grow.postures import grow_postures
from tallgrass.systems.grow.record import Blades
from tallgrass.systems.show.carpet.grow import grow_carpet
from tallgrass.systems.show.strips.grow import grow_strips

HIGH = PRESETS["high"]
PATCH = HIGH.patch
POPPY = GrassKind(plant="flower", height=[0.4, 0.6], head=Head(petals=5, size=[0.06, 0.09]))
HEATHER = GrassKind(plant="shrub", head=Head(form="spike"))
REED = GrassKind(height=[1.5, 2.2], blades=90, head=Head(form="plume", share=0.3))
KINDS = {
    "poppy": POPPY,
    "bell": GrassKind(plant="flower", head=Head(form="bell", open=0.5)),
    "umbel": GrassKind(plant="flower", head=Head(form="umbel", share=0.6)),
    "forb": GrassKind(plant="forb"),
    "lupin": GrassKind(plant="forb", head=Head(form="spike")),
    "heather": HEATHER,
    "reed": REED,
}
POSTURES = grow_postures(POPPY, variants=4, seed=2)


def grown(kind: GrassKind, seed: int = 1, preset: str = "high") -> Blades:
    quality = PRESETS[preset]
    return grow_patch(kind, layout_of(kind, quality), patch=quality.patch, variants=4, seed=seed)


def plants(blades: Blades) -> Iterator[NDArray[np.intp]]:
    """Return the rows of each plant."""
    for rank in np.unique(blades.rank):
        yield np.flatnonzero(blades.rank == rank)


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
@pytest.mark.parametrize("preset", ["low", "high"])
def test_f3_a_patch_has_the_rows_that_its_layout_says(kind: GrassKind, preset: str) -> None:
    blades, layout = grown(kind, preset=preset), layout_of(kind, PRESETS[preset])
    assert len(np.unique(blades.rank)) == layout.plants
    for field in fields(blades):
        values = getattr(blades, field.name)
        assert len(values) == layout.rows
        assert values.flags.c_contiguous
        assert values.dtype == (np.int32 if field.name in ("variant", "organ") else np.float32)
        assert np.isfinite(values).all()
    assert (np.linalg.norm(blades.rest, axis=1) < 1.0).all()
    assert ((blades.part >= 0.0) & (blades.part <= 1.0)).all()
    assert (np.abs(blades.facing) <= np.float32(np.pi)).all()
    assert (blades.width > 0.0).all()


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_f3_all_of_a_plant_stands_on_one_root_and_comes_and_goes_at_once(kind: GrassKind) -> None:
    blades, layout = grown(kind), layout_of(kind, HIGH)
    where = grow_blades(kind, count=layout.plants, patch=PATCH, variants=4, seed=1)
    assert (np.diff(blades.rank) >= 0.0).all()
    for number, rows in enumerate(plants(blades)):
        np.testing.assert_array_equal(blades.root[rows], np.tile(where.root[number], (len(rows), 1)))
        assert blades.rank[rows[0]] == where.rank[number]


def test_f3_a_grass_without_a_head_is_blades_of_which_some_hang() -> None:
    grass = GrassKind(blades=80)
    plain = let_hang(
        grow_blades(grass, count=80, patch=PATCH, variants=4, seed=1), grass, patch=PATCH, variants=4, seed=1
    )
    for field in fields(plain):
        np.testing.assert_array_equal(getattr(grown(grass), field.name), getattr(plain, field.name))


@settings(max_examples=25, deadline=None)
@given(st.sampled_from(sorted(KINDS)), st.floats(0.0, 1.0), st.floats(-np.pi, np.pi))
def test_f3_what_stands_on_a_stem_stays_on_it_in_any_wind(name: str, strength: float, toward: float) -> None:
    blades = grown(KINDS[name])
    message = strength * np.cos(toward), strength * np.sin(toward)
    knots = POSTURES.shape.shape[2]
    line = spine(blades, POSTURES, message, points=knots).astype(np.float64)
    stems = np.flatnonzero(blades.organ == organs.STEM)
    for stem in stems[:: max(len(stems) // 6, 1)].tolist():
        on_it = (blades.rank == blades.rank[stem]) & (blades.stem == blades.height[stem])
        on_it &= (blades.stem_rest == blades.rest[stem]).all(axis=1)
        at = blades.part[on_it].astype(np.float64) * (knots - 1)
        expected = np.stack([np.interp(at, np.arange(knots), line[stem, :, axis]) for axis in range(3)], axis=1)
        assert on_it.any() or KINDS[name].head is not None
        np.testing.assert_allclose(line[on_it, 0], expected, atol=2e-5)


def test_f3_at_a_coarser_quality_petals_drop_and_not_flowers() -> None:
    kind = KINDS["umbel"]
    fine, coarse = layout_of(kind, HIGH), layout_of(kind, PRESETS["low"])
    assert (fine.plants, fine.bearing) == (coarse.plants, coarse.bearing)
    assert fine.petals > coarse.petals >= 3
    petals = (grown(kind, preset=preset) for preset in ("high", "low"))
    area = [float((blades.width * blades.height)[blades.organ == organs.RAY].sum()) for blades in petals]
    assert area[1] / area[0] == pytest.approx(1.0, abs=0.35)


@pytest.mark.parametrize("share", [0.25, 0.6, 1.0])
def test_f3_of_the_first_few_plants_the_same_share_bears_heads(share: float) -> None:
    kind = GrassKind(plant="flower", plants=80, head=Head(share=share))
    bears = np.array([np.isin(grown(kind).organ[rows], organs.HEADS).any() for rows in plants(grown(kind))])
    assert bears.mean() == pytest.approx(share, abs=0.02)
    assert bears[:20].mean() == pytest.approx(share, abs=0.06)


@pytest.mark.parametrize(("form", "organ"), [("disc", organs.STRAP), ("bell", organs.PETAL), ("umbel", organs.RAY)])
def test_f3_heads_are_open_or_in_bud(form: str, organ: int) -> None:
    for share in (0.0, 1.0):
        kind = GrassKind.model_validate({"plant": "flower", "head": {"form": form, "open": share}})
        found = grown(kind).organ
        assert ((found == organ).any(), (found == organs.BUD).any()) == (share == 1.0, share == 0.0)


def widths_of_heads(blades: Blades) -> NDArray[np.float64]:
    """Return the widths of open heads, plant by plant [m]."""
    ends = spine(blades, POSTURES, (0.0, 0.0), points=9)[:, -1]
    petals = [rows[np.isin(blades.organ[rows], (organs.PETAL, organs.STRAP, organs.RAY))] for rows in plants(blades)]
    return np.array([np.ptp(ends[rows][:, ::2], axis=0).max() for rows in petals])


@pytest.mark.parametrize("form", ["disc", "umbel"])
def test_f3_an_open_head_is_as_wide_as_declared(form: str) -> None:
    kind = GrassKind.model_validate({"plant": "flower", "head": {"form": form, "open": 1.0, "size": [0.06, 0.08]}})
    blades = grown(kind)
    across = widths_of_heads(blades)
    assert 0.05 <= across.mean() <= 0.08
    assert across.max() <= 0.095


def test_f3_heads_of_one_size_are_of_all_ages() -> None:
    head = Head(petals=4, size=[0.07, 0.07], open=1.0)
    across = widths_of_heads(grown(GrassKind(plant="flower", plants=120, lean=0.0, head=head)))
    assert across.max() > 1.5 * across.min()


def test_f3_buds_of_few_petals_nod_and_what_has_set_seed_stands_up() -> None:
    head = Head(petals=4, size=[0.07, 0.07], open=0.0)
    blades = grown(GrassKind(plant="flower", plants=120, lean=0.0, leaves=0, head=head))
    leans = np.array(
        [np.linalg.norm(blades.rest[rows[blades.organ[rows] == organs.BUD]].mean(axis=0)) for rows in plants(blades)]
    )
    nod = leans > 0.45
    assert 0.4 < nod.mean() < 0.7
    assert leans[~nod].max() < 0.42


def test_the_table_of_organs_begins_with_blades_and_its_tones_and_widths_are_parts() -> None:
    assert organs.ORGANS[organs.BLADE] == organs.Organ((), (0.0, 1.0))
    assert all(len(organ.widths) == organs.GIVEN for organ in organs.ORGANS[1:])
    assert ((organs.TONES >= 0.0) & (organs.TONES <= 1.0)).all()
    assert ((organs.WIDTHS >= 0.0) & (organs.WIDTHS <= 1.0)).all()
    at_knots = organs.width_along(np.array([4], np.int32), np.linspace(0, 1, organs.KNOTS))
    np.testing.assert_allclose(at_knots, organs.WIDTHS[4:5])


def test_petals_are_round_in_outline_and_other_organs_have_straight_sides() -> None:
    bends = np.abs(np.diff(organs.WIDTHS, n=2, axis=1))
    assert (organs.WIDTHS[[organs.PETAL, organs.BLOTCHED], -1] < 0.2).all()  # no cut across their ends
    assert (organs.WIDTHS[[organs.PETAL, organs.BLOTCHED], -2] > 0.7).all()
    np.testing.assert_allclose(bends[organs.LEAF, ::2], 0.0, atol=1e-12)


def test_petals_have_the_tips_colour_and_stems_and_leaves_that_of_the_root() -> None:
    blades = grown(POPPY)
    tones = tone(blades, np.linspace(0.0, 1.0, 5))
    assert tones[np.isin(blades.organ, (organs.STEM, organs.LEAF))].max() < 0.1
    assert tones[blades.organ == organs.PETAL].mean() > 0.75
    wide = widths(blades, np.array([0.5]), 0.6)[:, 0]
    np.testing.assert_allclose(wide[blades.organ == organs.PETAL], blades.width[blades.organ == organs.PETAL])


@pytest.mark.parametrize("seed", range(1, 4))
def test_f3_a_flower_is_the_same_flower_in_every_representation(seed: int) -> None:
    kind = GrassKind(
        plant="flower", plants=1, leaves=0, height=[0.4, 0.6], head=Head(petals=6, size=[0.08, 0.08], open=1)
    )
    blades, size = grown(kind, seed), 0.08
    petals = blades.organ == organs.PETAL
    head = spine(blades, POSTURES, (0.0, 0.0), points=9)[petals].mean(axis=(0, 1)).astype(np.float64)

    strips = grow_strips(blades, POSTURES, patch=PATCH, strips=4, texel=0.006, taper=kind.taper, margin=0.2)
    for orientation in (0, 1):
        of_plane = strips.texels[orientation].astype(np.float64)
        red = np.maximum(2.0 * of_plane[..., 0] - of_plane[..., 3], 0.0)  # coverage where tones are above a half
        plane, up, along = (np.average(axis, weights=red) for axis in np.indices(red.shape) + 0.5)
        across = along / red.shape[2] * (PATCH + 2.0 * strips.margin) - strips.margin
        assert across == pytest.approx(head[2 * orientation], abs=size / 2)
        assert up / red.shape[1] * strips.height == pytest.approx(head[1], abs=size / 2)
        assert strips.plane[int(plane)] == pytest.approx(blades.root[0, 1 - orientation], abs=PATCH / 8 + 1e-3)

    carpet = grow_carpet(blades, POSTURES, patch=PATCH, texels=256, taper=kind.taper, slopes=(2.0,))
    image = carpet.texels[0, 0].astype(np.float64)
    red = np.maximum(2.0 * image[..., 0] - image[..., 3], 0.0)
    turns = [
        np.angle((red * np.exp(2j * np.pi * (axis + 0.5) / 256)).sum()) / (2.0 * np.pi)
        for axis in np.indices(red.shape)
    ]
    place = np.array(turns[::-1]) % 1.0 * PATCH  # of an endless field
    seen = head[::2] + np.array([0.0, -1.0]) * (head[1] - carpet.height / 2.0) / 2.0
    apart = (place - seen + PATCH / 2) % PATCH - PATCH / 2
    assert np.abs(apart).max() < size / 2


@pytest.mark.parametrize("petals", [3, 6, 18])
def test_f3_florets_cover_a_spike_from_end_to_end_and_stay_close_to_its_stem(petals: int) -> None:
    size = 0.2
    kind = GrassKind(plant="flower", leaves=0, lean=0.5, head=Head(form="spike", petals=petals, size=[size, size]))
    blades = grown(kind)
    line = spine(blades, POSTURES, (0.0, 0.0), points=POSTURES.shape.shape[2]).astype(np.float64)
    for rows in plants(blades):
        stem = line[rows[blades.organ[rows] == organs.STEM][0]]
        florets = line[rows[np.isin(blades.organ[rows], organs.HEADS)]]
        away = np.linalg.norm(florets[:, :, None] - stem[None, None], axis=-1)
        assert away.min(axis=2).max() < 0.45 * size
        first, last = florets[:, 0, 1], florets[:, -1, 1]
        order = np.argsort(first)
        assert (first[order][1:] - last[order][:-1]).max() < 0.15 * size


def test_f3_a_shrub_comes_branch_after_branch_so_that_its_heads_do_not_cover_all_its_leaves() -> None:
    blades = grown(HEATHER)
    for rows in plants(blades):
        stems = np.flatnonzero(blades.organ[rows] == organs.STEM)
        assert len(stems) > 1
        own = np.searchsorted(stems, np.arange(len(rows)), side="right") - 1
        on = blades.stem[rows] > 0.0
        np.testing.assert_array_equal(blades.stem[rows][on], blades.height[rows][stems[own]][on])
        assert (np.isin(blades.organ[rows][:-1], organs.HEADS) & (blades.organ[rows][1:] == organs.STEM)).any()


def test_a_stem_of_a_shrub_is_of_wood() -> None:
    flower, shrub = (
        GrassKind(plant=plant, height=[0.4, 0.4], head=Head(form="spike")) for plant in ("flower", "shrub")
    )
    widest = [grown(kind).width[grown(kind).organ == organs.STEM].max() for kind in (flower, shrub)]
    assert widest[1] > 1.5 * widest[0]
