"""Heads with an eye of a colour of its own, in whole frames."""

from collections.abc import Callable

import moderngl
import numpy as np
import pytest

from tallgrass.components.arrays import Doubles
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.show.blades import representation
from tallgrass.testing import Stage

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

BED = """\
tallgrass: 2
terrain: { noise: flat, size: [120, 120] }
light: { ground: "#000000", haze: 1e6 }
grass:
  bed:
    { plant: flower, plants: 60, leaves: 0, height: [0.4, 0.6], root: "#104010", tip: "#d02020", understorey: 0,
      translucency: 0, variety: 0, head: { petals: 20, size: [0.06, 0.08], eye: "#d02020", open: 1 } }
quality:
  blades: 500
  models: 1
  blade_rings: [{ to: 2, segments: 6 }]
  strip_rings: [{ to: 3, strips: 6, texel: 0.01 }]
  carpet_to: 16
  carpet: 256
"""
"""Flowers alone, on black ground; their eyes have the petals' colour unless a test sets another."""

BLUE, RED = BED.replace('eye: "#d02020"', 'eye: "#2020d0"'), BED


@pytest.mark.parametrize("petals", [20, pytest.param(5, marks=pytest.mark.slow)])
def test_a_head_near_by_has_an_eye_of_the_colour_that_is_declared_and_petals_about_it(
    stage: Stage, load: Load, camera: Aim, petals: int
) -> None:
    aim = camera(0.0, 1.6, 20.0, pitch=-60, view=30)
    picture = stage.shot(load(BLUE.replace("petals: 20", f"petals: {petals}")), aim).astype(float)
    red, green, blue = np.moveaxis(picture, -1, 0)
    eyes, petal = (blue > 60.0) & (blue > 2.0 * red), (red > 60.0) & (red > 2.0 * blue)
    assert 0.03 * petal.sum() < eyes.sum() < 0.5 * petal.sum()
    assert green[eyes].mean() < 0.6 * blue[eyes].mean()


def bluer(of_blue: Doubles, of_red: Doubles) -> float:
    """Return the fraction of eyes in the visible heads."""
    more, all_red = of_blue[..., 2] - of_red[..., 2], of_red[..., 0]
    return float(more.mean() / all_red.mean())


@pytest.mark.parametrize("petals", [20, pytest.param(5, marks=pytest.mark.slow)])
@pytest.mark.parametrize(("pitch", "high"), [(-8, 1.6), pytest.param(-25, 4.0, marks=pytest.mark.slow), (-50, 8.0)])
def test_as_much_of_an_eye_is_seen_in_every_representation(
    ctx: moderngl.Context, load: Load, petals: int, pitch: int, high: float
) -> None:
    room, aim = Stage(ctx, (120, 80)), Camera((0.0, high, 8.0), 0.0, np.radians(pitch), np.radians(12.0))
    seen = dict[str, list[Doubles]]()
    for scene in (each.replace("petals: 20", f"petals: {petals}") for each in (BLUE, RED)):
        for lod in ("blades", "strips", "carpet"):
            prairie = load(scene, lod=lod)
            seen.setdefault(lod, []).append(room.shot(prairie, aim).astype(float))
        room.target.use()
        truth = draw_truth(prairie, *room.matrices(aim), room.size, samples=3).picture.astype(float)
        seen.setdefault("truth", []).append(truth)
    room.release()
    parts = {name: bluer(*pair) for name, pair in seen.items()}
    assert parts["carpet"] == pytest.approx(parts["truth"], rel=0.3)
    if pitch > -30:  # from above, order alone draws discs whole before their petals
        assert parts["blades"] == pytest.approx(parts["truth"], rel=0.3)
    if pitch > -20:  # strips show heads as they are seen from aside
        assert parts["strips"] == pytest.approx(parts["truth"], rel=0.2)


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet"])
def test_heads_without_an_eye_are_the_same_picture_to_the_byte_where_others_have_one(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch, lod: str
) -> None:
    plain = BED.replace('eye: "#d02020", ', "").replace("variety: 0", "variety: 0.3")
    aim = camera(0.0, 1.6, 20.0, pitch=-20)
    alone = stage.shot(load(plain, lod=lod), aim)
    monkeypatch.setattr(representation, "any_eyes", lambda _: True)
    np.testing.assert_array_equal(stage.shot(load(plain, lod=lod), aim), alone)


@pytest.mark.parametrize(
    "lod", ["blades", *(pytest.param(lod, marks=pytest.mark.slow) for lod in ("strips", "carpet"))]
)
def test_heads_come_to_have_an_eye_and_another(stage: Stage, load: Load, camera: Aim, lod: str) -> None:
    """During the change, heads without an eye stay so, and new heads have no eye of the other colour."""
    aim, plain = camera(0.0, 1.6, 20.0, pitch=-20), BED.replace('eye: "#d02020", ', "")
    prairie = load(plain, lod=lod, live=False)
    pictures = [stage.shot(prairie, aim)]
    prairie.change_kind("bed", head={"eye": "#d02020"}, over=2.0)
    for _ in range(2):
        prairie.advance(1.0)
        pictures.append(stage.shot(prairie, aim))
    for scene, eye in ((RED, "#d02020"), (BLUE, "#2020d0")):
        prairie.change_kind("bed", head={"eye": eye})
        prairie.advance(1.0)
        due = load(scene, lod=lod, live=False)
        due.advance(prairie.time)
        np.testing.assert_array_equal(stage.shot(prairie, aim), stage.shot(due, aim))
    blue = [int(each[20:, :, 2].max()) for each in pictures]
    assert max(blue) < 1.3 * blue[0]
