"""Flowers, forbs and shrubs in whole frames: shaders compute the same as numpy (F3)."""

from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass import Footprint
from tallgrass.engine.camera import Camera, view_of
from tallgrass.systems.grow import organs
from tallgrass.systems.grow.bend import spine
from tallgrass.systems.grow.organs import width_along
from tallgrass.systems.grow.record import Blades, Growth
from tallgrass.systems.light.materials import pigment
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.show.blades import representation
from tallgrass.systems.show.blades.draw import RIBBON
from tallgrass.systems.show.blades.painter import BladesPainter
from tallgrass.systems.show.blades.plant import record_of, standing_blades
from tallgrass.systems.show.blades.representation import BladeRepresentation
from tallgrass.systems.show.blades.shown import BladesShown
from tallgrass.testing import LITTLE, Stage

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

GARDEN = LITTLE.replace(
    LITTLE[LITTLE.index("\ngrass:") + 1 : LITTLE.index("camera:")],
    """\
grass:
  grass: { height: [0.3, 0.5], width: 0.02 }
  poppy: { plant: flower, plants: 8, tip: "#dd2a12", head: { petals: 5 } }
  heather: { plant: shrub, plants: 4, tip: "#a45a9e", head: { form: spike } }
wind: [{ kind: breeze, strength: 0.5 }]
""",
).replace("noise: rolling", "noise: flat")
FIELD = """\
tallgrass: 2
seed: 4
terrain: { noise: flat, size: [120, 120] }
grass:
  barley: { height: [0.4, 0.6], width: 0.018 }
  poppy: { plant: flower, plants: 50, height: [0.45, 0.65], tip: "#dd2a12", head: { petals: 5, size: [0.07, 0.1] } }
quality:
  blades: 160
  models: 2
  blade_rings: [{ to: 8, segments: 3 }]
  strip_rings: [{ to: 12, strips: 2, columns: 1, sections: 1, texel: 0.02 }]
  carpet_to: 24
  carpet: 32
"""
QUALITY = """\
quality:
  models: 2
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 2, strips: 2, texel: 0.05 }]
  carpet_to: 16
  carpet: 128
"""
BED = """\
tallgrass: 2
terrain: { noise: flat, size: [120, 120] }
light: { ground: "#000000", haze: 1e6 }
grass:
  bed:
    { plant: flower, plants: 40, height: [0.4, 0.6], root: "#808080", tip: "#808080", understorey: 0, translucency: 0,
      head: { petals: 5, size: [0.06, 0.08] } }
quality:
  blades: 400
  models: 1
  blade_rings: [{ to: 2, segments: 4 }]
  strip_rings: [{ to: 3, strips: 2, texel: 0.05 }]
  carpet_to: 16
"""
"""Flowers alone, on black ground."""

MEADOW = (
    LITTLE.replace(
        LITTLE[LITTLE.index("\ngrass:") + 1 : LITTLE.index("camera:")],
        """\
grass: { meadow: { root: "#2b5a20", tip: "#d8b868", withered: 0 } }
""",
    )
    .replace("noise: rolling", "noise: flat")
    .replace("blades: 60", "blades: 400")
)

TOOTHED = (organs.FLORETS, organs.SPRIG)

LEAFY = MEADOW.replace("withered: 0", "understorey: 0").replace("#d8b868", "#5fb03a")

HEATH = MEADOW.replace(
    'tip: "#d8b868", withered: 0',
    'tip: "#b040a0", understorey: 0, plant: shrub, plants: 30, head: { form: spike }',
)

# Plumes take long to grow, so there are few.
REEDS = (
    MEADOW.replace(
        'tip: "#d8b868", withered: 0',
        'tip: "#b0977a", understorey: 0, height: [0.6, 0.9], head: { form: plume, size: [0.35, 0.35] }',
    )
    .replace("blades: 400", "blades: 100")
    .replace("models: 2", "models: 1")
)


@pytest.fixture(scope="module")
def garden(load: Load) -> Prairie:
    """Prairie of grass, poppies and heather on flat ground, in a breeze."""
    prairie = load(GARDEN)
    prairie.advance(2.0)
    return prairie


def test_f3_each_organ_is_drawn_where_numpy_has_it_and_with_its_own_pigment(stage: Stage, garden: Prairie) -> None:
    stage.shot(garden)
    assert garden.painter is not None
    painter, near = garden.painter.painters["blades"], garden.site.representations[0]
    assert isinstance(painter, BladesPainter)
    assert isinstance(near, BladeRepresentation)
    outlook = garden.viewers["main"]
    patches, shown = outlook.patches, outlook.shows(BladesShown).standing
    rows = patches.cell[shown.rows], patches.model[shown.rows], patches.turn[shown.rows]
    standing, _ = standing_blades(near.stock, *rows, garden.site.ground)
    heard = outlook.kept["blades"].receiving[0].messages.heard(shown.slots).reshape(*standing.shape, 2)
    numbers, first = np.frombuffer(painter.shelves.now.numbers.buffer.read(), np.uint32), painter.morph.stream.count
    kinds = list(garden.scene.grass.values())
    met = set()
    for ribbons in painter.groups:
        count = ribbons.stream.count
        made = np.frombuffer(ribbons.stream.buffer.read(), RIBBON)[:count]
        at = np.divmod(numbers[first : first + count].astype(np.int64), standing.shape[1])
        blade, message = standing[at], heard[at]
        for kind, growth in enumerate(garden.site.growths):
            own = blade["kind"] == kind
            foot = foot_of(blade[own], growth, message[own])
            foot[:, 1] += blade["root"][own, 1]
            np.testing.assert_allclose(made["foot"][own, :3], foot, atol=2e-3)
            np.testing.assert_array_equal(made["canopy_organ"][own, 2], blade["organ"][own])
            np.testing.assert_array_equal(made["foot"][own, 3], blade["height"][own])
            low, high = (pigment(color) for color in (kinds[kind].root, kinds[kind].tip))
            for organ in np.unique(blade["organ"][own]).astype(int).tolist():
                met.add(organ)
                some = own & (blade["organ"] == organ)
                ends = [low + (high - low) * tone for tone in organs.TONES[organ]]
                # What grain and dry stretches do to a blade they do to both of its ends.
                ratio = made["root_pigment"][some, :3] / ends[0] * ends[1] / made["tip_pigment"][some, :3]
                np.testing.assert_allclose(ratio, 1.0, atol=1e-3)
        first += count
    assert met >= {organs.BLADE, organs.STEM, organs.LEAF, organs.PETAL, organs.EYE, organs.BUD, *TOOTHED}


def test_f3_each_organ_is_as_broad_along_itself_as_numpy_has_it(ctx: moderngl.Context, garden: Prairie) -> None:
    room, aim, each = Stage(ctx, (120, 200)), Camera((0.0, 0.25, 6.0), 0.0, 0.0, np.radians(5.0)), []
    room.shot(garden, aim)
    assert garden.painter is not None
    painter = garden.painter.blade_painter(32)
    for organ in (None, organs.STEM, organs.LEAF, organs.PETAL, organs.EYE):
        one = np.zeros(0 if organ is None else 1, record_of(garden.site.growths))
        one["kind"], one["organ"], one["height"], one["width"] = 1, organ or 0, 0.4, 0.2
        one["facing"] = 0.0, 1.0
        painter.write(one, np.zeros((len(one), 2), np.float32))
        room.begin()
        garden.painter.draw(view_of(*room.matrices(aim)), blades=[painter])
        each.append((organ, room.read()))
    painter.release()
    room.release()
    (_, bare), *grown = each
    for organ, picture in grown:
        broad = (np.abs(picture - bare).max(axis=2) > 3.0).sum(axis=1)
        rows = np.flatnonzero(broad)
        place = 1.0 - (np.arange(len(rows)) + 0.5) / len(rows)
        due = width_along(np.array([organ]), place)[0]
        assert len(rows) > 100
        np.testing.assert_allclose(broad[rows] / broad.max(), due / due.max(), atol=0.05)


def test_of_narrow_stems_and_small_organs_a_part_is_drawn_that_is_as_wide_as_all(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    prairie, eye = load(FIELD), (0.0, 50.0)
    stage.shot(prairie, camera(0.0, 1.2, 50.001))
    assert prairie.painter is not None
    painter, near = prairie.painter.painters["blades"], prairie.site.representations[0]
    assert isinstance(painter, BladesPainter)
    assert isinstance(near, BladeRepresentation)
    drawn, records = painter.shelves.now.counts[-1], near.stock.records
    monkeypatch.setattr(painter, "_drawn_to", lambda *_: np.float32(np.inf))
    stage.shot(prairie, camera(eye[0], 1.2, eye[1]))
    outlook, counts = prairie.viewers["main"], painter.shelves.now.counts
    patches, shown = outlook.patches, outlook.shows(BladesShown).standing
    numbers = np.frombuffer(painter.shelves.now.numbers.buffer.read(), np.uint32)[sum(counts[:-1]) :][: counts[-1]]
    made = np.frombuffer(painter.groups[-1].stream.buffer.read(), RIBBON)[: counts[-1]]
    patch, blade = np.divmod(numbers.astype(np.int64), records.shape[1])
    place = patches.model[shown.rows[patch]] * 4 + patches.turn[shown.rows[patch]], blade
    own, wide = records[place], 2.0 * np.linalg.norm(made["lean_across"][:, 2:], axis=1)
    places = outlook.kept["blades"].receiving[0].pool.places(shown.slots)
    away = np.hypot(*(places[patch, blade] - np.array(eye, np.float32)).T)
    left_out = away > near.stock.drawn_to[place]
    assert drawn == pytest.approx(len(made) - left_out.sum(), rel=0.01)
    np.testing.assert_allclose(wide[left_out], 0.0, atol=1e-5)
    for organ, far in ((organs.STEM, 14.0), (organs.EYE, 14.0), (organs.BLADE, 0.0)):
        some = (own["organ"] == organ) & (away > far)
        assert some.sum() > 100
        assert left_out[some].mean() == (0.0 if organ == organs.BLADE else pytest.approx(0.5, abs=0.4))
        assert wide[some].sum() == pytest.approx(own["width"][some].sum(), rel=0.04)


def foot_of(records: Any, growth: Growth, message: Any) -> Any:
    """Return the places at which ribbons begin, computed by numpy from their records, shape (n, 3)."""
    blades = Blades(
        root=np.ascontiguousarray(records["root"][:, ::2]), height=records["height"], width=records["width"],
        facing=np.arctan2(*records["facing"].T[::-1]), rest=records["rest"], variant=np.zeros(len(records), np.int32),
        rank=np.zeros(len(records), np.float32), organ=records["organ"].astype(np.int32), stem=records["stem"],
        part=records["part"], stem_rest=records["sways"],
    )  # fmt: skip
    return spine(blades, growth.postures, message, points=2)[:, 0]


def test_f3_in_every_representation_a_field_of_poppies_has_one_colour(stage: Stage, load: Load, camera: Aim) -> None:
    aim, rows, means = camera(0.0, 1.6, 50.0, pitch=-3, view=30), slice(50, 66), []
    for lod in ("blades", "strips", "carpet"):
        means.append(stage.shot(load(FIELD, lod=lod), aim).astype(float)[rows].mean(axis=(0, 1)))
        np.testing.assert_allclose(means[-1], means[0], rtol=0.06, err_msg=lod)


@pytest.mark.parametrize("texels", [48, 64])
def test_f3_flowers_alone_hide_as_much_of_the_ground_on_carpets_from_above(
    ctx: moderngl.Context, load: Load, texels: int
) -> None:
    """Their leaves and petals lie, so more of them is seen from above. The number of texels is no power of two."""
    room, aim = Stage(ctx, (96, 64)), Camera((0.0, 26.0, 15.0), 0.0, -1.05, np.radians(20.0))
    blades, carpet = (
        room.shot(load(BED + f"  carpet: {texels}\n", lod=lod), aim).mean() for lod in ("blades", "carpet")
    )
    room.release()
    assert blades > 5.0
    assert carpet == pytest.approx(blades, rel=0.1)


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet"])
@pytest.mark.parametrize(
    ("scene", "key", "part", "pitch", "redder"),
    [
        (MEADOW, "withered", 0.6, -12, 1.053),
        pytest.param(LEAFY, "understorey", 1.0, -30, 0.583, marks=pytest.mark.slow),
        (HEATH, "understorey", 1.0, -30, 0.526),
    ],
)
def test_dead_blades_and_an_understorey_colour_a_field_alike_in_every_representation(
    stage: Stage, load: Load, camera: Aim, lod: str, scene: str, key: str, part: float, pitch: float, redder: float
) -> None:
    aim, ratio = camera(0.0, 1.6, 20.0, pitch=pitch), []
    for some in (0.0, part):
        prairie = load(scene.replace(f"{key}: 0", f"{key}: {some}"), lod=lod)
        red, green, _ = stage.shot(prairie, aim)[60:].mean(axis=(0, 1))
        ratio.append(red / green)
    assert ratio[1] / ratio[0] == pytest.approx(redder, abs=0.016)


def test_f3_the_reference_has_the_flowers_of_the_picture(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim = load(FIELD), camera(0.0, 1.2, 50.0, pitch=-20, view=45)
    picture = stage.shot(prairie, aim).astype(float)
    stage.target.use()
    view, projection = stage.matrices(aim)
    truth = draw_truth(prairie, view, projection, stage.size, samples=4).picture.astype(float)
    red, red_of_truth = (each[..., 0] > 1.3 * each[..., 1] for each in (picture, truth))
    assert red_of_truth.sum() > 100
    assert (red & red_of_truth).sum() > 0.75 * red_of_truth.sum()
    assert red.sum() == pytest.approx(red_of_truth.sum(), rel=0.2)


DANDELIONS = (
    FIELD.replace('"#dd2a12", head: { petals: 5,', '"#ffd21c", head: { petals: 12, open: 1,')
    .replace("plants: 50", "plants: 400")
    .replace("blades: 160", "blades: 500")
)
DAISIES = DANDELIONS.replace('"#ffd21c", head: {', '"#f1efe6", head: { eye: "#eeb611",')


@pytest.mark.parametrize(
    ("scene", "eye", "pitch", "view", "off"),
    [
        pytest.param(HEATH, (0.0, 0.5, 3.0), -15.0, 15.0, 0.02, id="florets and leaves of twigs"),
        pytest.param(REEDS, (0.0, 0.8, 4.0), -10.0, 15.0, 0.02, id="spikelets of plumes"),
        pytest.param(DANDELIONS, (0.0, 1.0, 50.0), -35.0, 12.0, 0.03, id="dandelions", marks=pytest.mark.slow),
        pytest.param(DAISIES, (0.0, 1.0, 50.0), -35.0, 12.0, 0.05, id="daisies", marks=pytest.mark.slow),
    ],
)
def test_f3_what_an_organ_is_made_of_stands_out_near_by_and_leaves_the_colour_of_all_as_it_is(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch,
    scene: str, eye: tuple[float, float, float], pitch: float, view: float, off: float,
) -> None:  # fmt: skip
    """Broad petals that lie over one another hide a little less when they are parted."""
    aim, pictures = camera(*eye, pitch=pitch, view=view), []
    for _ in range(2):
        pictures.append(stage.shot(load(scene, lod="blades"), aim).astype(float))
        monkeypatch.setattr(representation, "any_with", lambda *_: False)
    fine, whole = pictures
    assert np.abs(fine - whole).mean() > 1.0
    np.testing.assert_allclose(fine.mean(axis=(0, 1)), whole.mean(axis=(0, 1)), rtol=off)


def test_f3_broad_petals_seen_aslant_have_the_outline_of_the_references(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim = load(FIELD), camera(0.0, 1.0, 50.0, pitch=-35, view=30)
    picture = stage.shot(prairie, aim).astype(float)
    stage.target.use()
    truth = draw_truth(prairie, *stage.matrices(aim), stage.size, samples=4).picture.astype(float)
    red, of_truth = (each[..., 0] > 1.3 * each[..., 1] for each in (picture, truth))
    assert of_truth.sum() > 300
    assert (red & of_truth).sum() > 0.85 * (red | of_truth).sum()


def test_f3_florets_far_off_are_drawn_without_their_teeth(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    aim = camera(0.0, 30.0, 3.0, pitch=-80, view=40)
    toothed = stage.shot(load(HEATH, lod="blades"), aim)
    monkeypatch.setattr(representation, "any_with", lambda *_: False)
    np.testing.assert_array_equal(stage.shot(load(HEATH, lod="blades"), aim), toothed)


def test_f3_far_off_flowers_are_as_faint_as_those_of_the_reference(stage: Stage, load: Load, camera: Aim) -> None:
    pasture = FIELD.replace("[0.4, 0.6]", "[0.1, 0.2], blades: 200").replace(
        "plants: 50, height: [0.45, 0.65]", "plants: 8"
    )
    prairie = load(pasture.replace("quality: low", QUALITY), lod="carpet")
    aim, middle = camera(0.0, 6.0, 59.0, pitch=-4.3, view=20), stage.size[1] // 2
    pictures = stage.shot(prairie, aim), draw_truth(prairie, *stage.matrices(aim), stage.size, samples=3).picture
    far = slice(middle - 6, middle + 6)  # 60 to 115 m off
    drawn, true = (np.percentile(each[far, :, 0].astype(float) - each[far, :, 2], [50, 99.7]) for each in pictures)
    assert drawn[1] - drawn[0] < 1.35 * (true[1] - true[0])  # a sharper filter than Mesa's takes 1.31


def test_f3_flowers_smaller_than_pixels_hide_as_much_as_those_of_the_reference(
    stage: Stage, load: Load, camera: Aim
) -> None:
    alone = FIELD.replace("  barley: { height: [0.4, 0.6], width: 0.018 }\n", "").replace("petals: 5", "petals: 12")
    prairie = load(alone.replace("plants: 50,", "plants: 12, leaves: 0,"), lod="blades")
    aim = camera(0.0, 9.0, 59.0, pitch=-28, view=16)
    pictures = stage.shot(prairie, aim), draw_truth(prairie, *stage.matrices(aim), stage.size, samples=3).picture
    redder = [each[..., 0].astype(float) - each[..., 2] for each in pictures]
    hidden, brightest = zip(*((each.mean(), np.percentile(each, 99.7)) for each in redder), strict=True)
    assert hidden[0] - np.median(redder) == pytest.approx(hidden[1] - np.median(redder), rel=0.15)
    assert brightest[0] == pytest.approx(brightest[1], rel=0.1)


THINLY = """\
tallgrass: 2
seed: 4
terrain: { noise: flat, size: [40, 40] }
grass:
  barley: { height: [0.2, 0.3], width: 0.018 }
  poppy: { plant: flower, plants: 50, height: [0.45, 0.65], tip: "#dd2a12", head: { petals: 5, size: [0.16, 0.2] } }
quality:
  blades: 160
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 8, strips: 2, texel: 0.01 }]
  carpet_to: 12
  carpet: 32
"""


def test_f3_flowers_that_grow_thinly_stand_whole_on_strips(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim, red = load(THINLY, lod="strips"), camera(0.0, 6.0, 20.0, pitch=-17.0, view=20), []
    for density in (1.0, 0.3):
        prairie.sow("poppy", Footprint(radius=60.0), density)
        picture = stage.shot(prairie, aim).astype(float)
        red.append(np.percentile(picture[..., 0] - picture[..., 1], 99.9))
    assert red[1] > 0.88 * red[0]  # 0.77 where all of them fade instead
