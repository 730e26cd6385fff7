"""More kinds than a vector has components: each has its place, colour and response to wind (D4, N1, W12)."""

import colorsys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from PIL import Image

from tallgrass import Footprint, Pose, Presser
from tallgrass.components.arrays import Doubles, Floats
from tallgrass.engine.camera import Camera
from tallgrass.engine.terrain.sample import density_at
from tallgrass.systems.around.receivers import Receiving
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.testing import LITTLE

Stage = Any
Aim = Callable[..., Camera]
OnCard = Callable[[Prairie], list[tuple[Receiving, Floats]]]

SIDE, NINE = 3, 9
"""Width of the stretch of one kind [m], and the number of kinds."""

ALL = Footprint(radius=30.0)

PLANTS = [
    *(f"height: [0.3, 0.5], width: 0.03, stiffness: {0.5 + 0.5 * kind}" for kind in range(6)),
    "plant: flower, plants: 90, understorey: 1, height: [0.3, 0.5], head: { petals: 5, size: [0.07, 0.1] }",
    "plant: forb, plants: 60, understorey: 1, height: [0.2, 0.4]",
    "plant: shrub, plants: 20, height: [0.2, 0.4]",
]

SCENE = """\
tallgrass: 2
seed: 5
terrain: { noise: flat, size: [27, 27] }
grass:
KINDS
wind: [{ kind: breeze, strength: 0.4 }]
light: { ground: "#808080" }
quality:
  blades: 200
  models: 1
  blade_rings: [{ to: 7, segments: 3 }]
  strip_rings: [{ to: 9, strips: 5, columns: 1, sections: 2, texel: 0.02 }]
  carpet_to: 12
  carpet: 64
"""


def color(kind: int) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in colorsys.hsv_to_rgb(kind / NINE, 0.85, 0.85))


def described(kind: int) -> str:
    place = f"{{ map: map-{kind // 3}.png, channel: {('red', 'green', 'blue')[kind % 3]} }}"
    return f'  kind-{kind}: {{ {PLANTS[kind]}, root: "{color(kind)}", tip: "{color(kind)}", place: {place} }}'


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Path of a scene of nine kinds of different hues, each alone on a stretch of flat ground, from left to right."""
    folder = tmp_path_factory.mktemp("nine")
    for number in range(3):
        picture = np.zeros((27, 27, 3), np.uint8)
        for channel in range(3):
            picture[:, SIDE * (3 * number + channel) :, channel][:, :SIDE] = 255
        Image.fromarray(picture).save(folder / f"map-{number}.png")
    path = folder / "scene.yaml"
    path.write_text(SCENE.replace("KINDS", "\n".join(map(described, range(NINE)))), "utf-8")
    return path


@pytest.fixture(scope="module")
def load(ctx: moderngl.Context, scene: Path) -> Iterator[Callable[[str], Prairie]]:
    """Return the function that loads the scene in one representation, once for each."""
    loaded: dict[str, Prairie] = {}

    def with_lod(lod: str) -> Prairie:
        if lod not in loaded:
            loaded[lod] = Prairie.load(scene, ctx=ctx, lod=lod)  # type: ignore[arg-type]
        return loaded[lod]

    yield with_lod
    for prairie in loaded.values():
        prairie.release()


def hues(picture: Doubles, stage: Stage, aim: Camera) -> Doubles:
    """Return the hue in the middle of each kind's stretch, as a fraction of a turn."""
    across, ahead = np.moveaxis(stage.ground(aim, 0.2), -1, 0)
    found = []
    for kind in range(NINE):
        middle = SIDE * (kind + 0.5) - 13.5
        mine = (np.abs(across - middle) < 0.25 * SIDE) & (np.abs(ahead) < 8.0)
        assert mine.sum() > 60
        found.append(colorsys.rgb_to_hsv(*(picture[mine].mean(axis=0) / 255.0))[0])
    return np.array(found)


def must_be_each_in_its_place(found: Doubles) -> None:
    off = found - np.arange(NINE) / NINE
    assert np.abs(off - np.round(off)).max() < 0.4 / NINE


@pytest.mark.slow
@pytest.mark.parametrize("lod", ["blades", "strips", "carpet", "auto"])
def test_each_of_nine_kinds_shows_its_color_where_it_grows_mown_or_not(
    stage: Stage, load: Callable[[str], Prairie], camera: Aim, lod: str
) -> None:
    prairie, aim = load(lod), camera(0.0, 14.0, 15.0, pitch=-40, view=75)
    must_be_each_in_its_place(hues(stage.shot(prairie, aim), stage, aim))
    prairie.cut(ALL, 0.15)
    must_be_each_in_its_place(hues(stage.shot(prairie, aim), stage, aim))
    prairie.grow(ALL)


@pytest.mark.slow
def test_each_of_nine_kinds_shows_its_color_in_the_reference(
    stage: Stage, load: Callable[[str], Prairie], camera: Aim
) -> None:
    prairie, aim = load("auto"), camera(0.0, 14.0, 15.0, pitch=-40, view=75)
    stage.shot(prairie, aim)
    view, projection = stage.matrices(aim)
    picture = draw_truth(prairie, view, projection, stage.size, samples=1).picture
    must_be_each_in_its_place(hues(picture.astype(np.float64), stage, aim))


@pytest.mark.slow
def test_w12_each_of_nine_kinds_is_told_on_the_card_what_a_game_is_told(
    stage: Stage, load: Callable[[str], Prairie], camera: Aim, on_card: OnCard
) -> None:
    prairie, aim = load("auto"), camera(0.0, 14.0, 15.0, pitch=-40, view=75)
    presser = esper.create_entity(Presser(radius=1.0))
    for step in range(5):
        prairie.advance(0.3)
        esper.add_component(presser, Pose(-12.0 + 6.0 * step, 3.0, np.pi / 2))
        stage.shot(prairie, aim)
    dense, bent = np.zeros(NINE), np.zeros(NINE)
    for receiving, texels in on_card(prairie):
        place, kinds = receiving.pool.places(receiving.slots).reshape(-1, 2), receiving.pool.kind(receiving.slots)
        told = texels.reshape(-1, 4)
        due = density_at(prairie.site.ground.density, place)[kinds, np.arange(len(kinds))]
        np.testing.assert_allclose(told[:, 3], due, atol=1.5 / 255)
        for kind in range(NINE):
            own = kinds == kind
            felt = prairie.bent_at(place[own], kind=f"kind-{kind}")
            np.testing.assert_allclose(told[own, :2], felt, atol=1e-3, rtol=0.0)
            dense[kind] = max(dense[kind], due[own].max(initial=0.0))
            bent[kind] = max(bent[kind], np.linalg.norm(felt, axis=1).max(initial=0.0))
    esper.delete_entity(presser, immediate=True)
    assert (dense > 0.99).all()
    assert (bent > 0.5).all()


ALONE = [pytest.param(lod, marks=pytest.mark.slow) for lod in ("blades", "strips", "carpet")]


@pytest.mark.parametrize("lod", [*ALONE, "auto"])
def test_no_kind_shows_beyond_its_field_which_ends_within_a_patch(
    ctx: moderngl.Context, stage: Stage, camera: Aim, lod: str
) -> None:
    """Neither its leaves nor the litter below them."""
    across, aim = np.arange(-19.9, 20.0, 0.2), camera(0.0, 14.0, 15.0, pitch=-40, view=75)
    red = np.tile(across > 0.9, (200, 1)).astype(np.float32)
    fields: dict[str, Any] = {
        "red": {"root": "#c01010", "tip": "#e02020", "place": {"map": red}},
        "green": {"root": "#106010", "tip": "#208020", "place": {"map": 1.0 - red}},
    }
    grass = {name: {"height": [0.3, 0.4], "blades": 200} | more for name, more in fields.items()}
    terrain = {"noise": "flat", "size": [40, 40]}
    values: Any = {"tallgrass": 2, "terrain": terrain, "grass": grass, "quality": "low"}
    prairie = Prairie.load(values, ctx=ctx, lod=lod)  # type: ignore[arg-type]
    picture, (x, z) = stage.shot(prairie, aim), np.moveaxis(stage.ground(aim, 0.15), -1, 0)
    prairie.release()
    redder = []
    for low, high in ((0.4, 1.1), (3.0, 6.0)):
        beside = (0.9 - x > low) & (0.9 - x < high) & (np.abs(z) < 8.0)
        assert beside.sum() > 60
        redder.append(np.divide(*picture[beside].mean(axis=0)[:2]))
    assert redder[0] < 1.15 * redder[1]


@pytest.mark.slow
def test_kinds_that_grow_nowhere_change_nothing(ctx: moderngl.Context, stage: Stage, tmp_path: Path) -> None:
    Image.new("L", (4, 4)).save(tmp_path / "nowhere.png")
    more = [f"  more-{number}: {{ blades: 1, place: {{ map: nowhere.png }} }}\n" for number in range(3)]
    pictures = []
    for number, text in enumerate((LITTLE, LITTLE.replace("camera:", "".join(more) + "camera:"))):
        path = tmp_path / f"scene-{number}.yaml"
        path.write_text(text, "utf-8")
        prairie = Prairie.load(path, ctx=ctx)
        whole = stage.shot(prairie)
        prairie.cut(Footprint(radius=8.0), 0.1)
        pictures.append(np.stack([whole, stage.shot(prairie)]))
        prairie.release()
    difference = np.abs(pictures[1] - pictures[0])
    assert difference.mean() < 0.12
    assert np.quantile(difference, 0.99) < 2.5


@pytest.mark.slow
def test_n7_a_scene_may_come_to_have_nine_kinds_and_have_few_again(
    ctx: moderngl.Context, stage: Stage, camera: Aim, scene: Path
) -> None:
    aim, whole = camera(0.0, 14.0, 15.0, pitch=-40, view=75), scene.read_text("utf-8")
    few = scene.with_name("few.yaml")
    two = "\n".join(line for line in whole.splitlines() if not line.startswith("  kind-") or line[7] in "78")
    few.write_text(two, "utf-8")
    prairie = Prairie.load(few, ctx=ctx, lod="blades")
    before = stage.shot(prairie, aim)
    few.write_text(whole, "utf-8")
    prairie.reload()
    must_be_each_in_its_place(hues(stage.shot(prairie, aim), stage, aim))
    few.write_text(two, "utf-8")
    prairie.reload()
    np.testing.assert_array_equal(stage.shot(prairie, aim), before)
    prairie.release()
