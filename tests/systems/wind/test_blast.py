"""The blast of air (W9): a mask of any outline, directions radial to it."""

from collections.abc import Callable, Sequence
from math import radians
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from tallgrass.components.arrays import Floats
from tallgrass.components.declaration import DeclarationError
from tallgrass.engine.scene import SceneError, parse_scene, read_scene
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.outline import outline_of_picture, outline_of_polygon

Feel = Callable[..., Floats]

SQUARE = Shape(polygon=[[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]])
ELL = Shape(polygon=[[-5.0, -5.0], [-1.0, -5.0], [-1.0, 1.0], [5.0, 1.0], [5.0, 5.0], [-5.0, 5.0]])
GOOD = "tallgrass: 2\ngrass: { lawn: {} }\nwind:\n  - kind: blast\n"


def blast(outline: Shape, **more: object) -> Blast:
    return Blast.model_validate({"outline": outline, "swing": 0.0, "soft": 0.0, **more})


def directions(message: Floats) -> Floats:
    index = np.linalg.norm(message, axis=1)
    assert index.min() > 1e-3
    return np.asarray(message / index[:, None])


def on_ellipse(across: float, along: float, part: float) -> tuple[Floats, Floats, Floats]:
    """Return places inside of an ellipse's outline along its normals, these normals, and directions from its middle."""
    angle = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
    edge = np.stack([across * np.cos(angle), along * np.sin(angle)], axis=1)
    normal = np.stack([np.cos(angle) / across, np.sin(angle) / along], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    place = edge - part * normal
    centric = place / np.linalg.norm(place, axis=1, keepdims=True)
    return place.astype(np.float32), normal.astype(np.float32), centric.astype(np.float32)


@pytest.mark.parametrize(("across", "along"), [(2.0, 6.0), (5.0, 2.5), (3.0, 3.0)])
def test_w9_directions_are_radial_to_an_ellipses_outline_and_not_to_its_middle(
    feel: Feel, across: float, along: float
) -> None:
    place, normal, centric = on_ellipse(across, along, 0.3)
    told = directions(feel(blast(Shape(ellipse=[across, along])), place=place, time=1.0))
    off = np.degrees(np.arccos(np.clip((told * normal).sum(axis=1), -1.0, 1.0)))
    assert off.max() < 9.0
    if across != along:
        astray = np.degrees(np.arccos(np.clip((told * centric).sum(axis=1), -1.0, 1.0)))
        assert astray.max() > 25.0


def test_w9_along_a_polygons_side_grass_bends_straight_across_it(feel: Feel) -> None:
    along = np.linspace(-2.5, 2.5, 21)
    for number, out in enumerate(([1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0])):
        side = np.array(out)
        place = (3.5 * side + along[:, None] * np.array([-side[1], side[0]])).astype(np.float32)
        told = directions(feel(blast(SQUARE), place=place, time=1.0))
        np.testing.assert_allclose(told, np.broadcast_to(out, told.shape), atol=0.03, err_msg=f"side {number}")


def test_w9_in_a_hollow_corner_grass_bends_into_the_hollow(feel: Feel) -> None:
    place = np.array([[-1.5, -3.0], [3.0, 1.5], [-1.4, 1.4]], np.float32)
    told = directions(feel(blast(ELL), place=place, time=1.0))
    np.testing.assert_allclose(told[:2], [[1.0, 0.0], [0.0, -1.0]], atol=0.05)
    np.testing.assert_allclose(told[2], [np.sqrt(0.5), -np.sqrt(0.5)], atol=0.1)


def holds(corners: Sequence[Sequence[float]], place: Floats) -> NDArray[np.bool_]:
    """Return the mask of places inside a polygon by the even-odd rule, one place and side after another."""
    inside = np.zeros(len(place), np.bool_)
    for (ax, az), (bx, bz) in zip(corners, [*corners[1:], corners[0]], strict=True):
        for k, (x, z) in enumerate(place.tolist()):
            if (az > z) != (bz > z) and x < ax + (bx - ax) * (z - az) / (bz - az):
                inside[k] = not inside[k]
    return inside


@given(st.lists(st.tuples(st.floats(-8, 8), st.floats(-8, 8)), min_size=3, max_size=8), st.integers(0, 99))
def test_w9_any_polygon_is_its_mask_but_for_a_sample(corners: list[tuple[float, float]], seed: int) -> None:
    try:
        shape = Shape(polygon=[list(corner) for corner in corners])
    except ValueError:
        return
    wind, outline = blast(shape), shape.outline()
    place = np.random.default_rng(seed).uniform(-9.0, 9.0, (60, 2)).astype(np.float32)
    mask = wind.mask(place, time=0.0) > 0.0
    depth, _ = outline.at(place)
    clear = np.abs(depth) > 1.5 * outline.step
    np.testing.assert_array_equal(mask[clear], holds(corners, place)[clear])


def test_w9_it_is_radial_to_a_pictures_outline_and_its_top_lies_ahead(feel: Feel, tmp_path: Path) -> None:
    """The picture has a tall bar in its upper half."""
    pixels = np.zeros((80, 80), np.uint8)
    pixels[4:36, 30:50] = 255
    Image.fromarray(pixels).save(tmp_path / "bar.png")
    wind = blast(Shape(image=str(tmp_path / "bar.png"), width=16.0))
    ahead, behind = np.array([[0.0, -4.0]], np.float32), np.array([[0.0, 4.0]], np.float32)
    assert wind.mask(ahead, time=0.0)[0] > 0.0
    assert wind.mask(behind, time=0.0)[0] == 0.0
    z = np.linspace(-5.0, -3.0, 20)
    right = np.stack([np.full(20, 1.5), z], axis=1).astype(np.float32)
    np.testing.assert_allclose(directions(feel(wind, place=right, time=0.4)), [[1.0, 0.0]] * 20, atol=0.05)
    inside = np.random.default_rng(0).uniform([-1.95, -7.15], [1.95, -0.85], (200, 2)).astype(np.float32)
    assert (wind.mask(inside, time=0.0) > 0.0).all()
    outside = np.random.default_rng(0).uniform([2.3, -8.0], [8.0, 8.0], (200, 2)).astype(np.float32)
    assert (wind.mask(outside, time=0.0) == 0.0).all()


def test_w9_a_picture_with_clear_parts_is_its_opaque_part(tmp_path: Path) -> None:
    pixels = np.zeros((40, 40, 4), np.uint8)
    pixels[10:30, 10:30, 3] = 255
    Image.fromarray(pixels).save(tmp_path / "black.png")
    wind = blast(Shape(image=str(tmp_path / "black.png"), width=8.0))
    place = np.array([[0.0, 0.0], [1.9, 1.9], [2.2, 0.0], [3.5, 3.5]], np.float32)
    assert (wind.mask(place, time=0.0) > 0.0).tolist() == [True, True, False, False]


@given(st.integers(0, 2**32 - 1), st.integers(3, 40), st.integers(3, 40))
def test_w9_depth_in_a_picture_is_the_distance_to_the_nearest_pixel_outside(seed: int, rows: int, columns: int) -> None:
    pixels = np.random.default_rng(seed).random((rows, columns)) < 0.7
    pixels[0, 0], pixels[-1, -1] = True, False
    outline = outline_of_picture(pixels, width=float(columns))
    framed = np.pad(pixels, 2)
    outside = np.argwhere(~framed)
    at = np.argwhere(framed)
    nearest = np.sqrt(((at[:, None] - outside[None]) ** 2).sum(axis=2).min(axis=1))
    np.testing.assert_allclose(outline.depth[framed], nearest - 0.5, atol=1e-4)
    assert (outline.depth[~framed] < 0.0).all()


@pytest.mark.parametrize("radius", [0.1, 1.0, 7.3, 600.0])
def test_w9_depth_in_a_disc_is_the_way_to_its_edge(radius: float) -> None:
    outline = Shape(disc=radius).outline()
    away = np.random.default_rng(1).uniform(0.0, 1.0, 100) * radius
    angle = np.linspace(0.0, 20.0, 100)
    place = np.stack([away * np.cos(angle), away * np.sin(angle)], axis=1).astype(np.float32)
    np.testing.assert_allclose(outline.at(place)[0], radius - away, atol=0.03 * radius)
    assert outline.deepest == pytest.approx(radius, rel=0.03)


def test_w9_it_turns_and_moves_with_what_carries_it(feel: Feel) -> None:
    straight = blast(Shape(ellipse=[1.5, 5.0]))
    turned = blast(Shape(ellipse=[1.5, 5.0]), yaw=90.0, position=[20.0, 0.0])
    east = np.array([[24.0, 0.0], [20.0, 4.0], [23.0, 0.8]], np.float32)
    north = np.array([[0.0, -4.0], [4.0, 0.0], [0.8, -3.0]], np.float32)
    told, expected = feel(turned, place=east, time=1.3), feel(straight, place=north, time=1.3)
    assert (np.linalg.norm(told, axis=1) > 0.0).tolist() == [True, False, True]
    c, s = np.cos(radians(90.0)), np.sin(radians(90.0))
    np.testing.assert_allclose(told, expected @ np.array([[c, s], [-s, c]]), atol=1e-4)


def test_w9_rings_run_outwards_through_it(feel: Feel) -> None:
    place = np.stack([np.linspace(1.2, 3.6, 300), np.zeros(300)], axis=1).astype(np.float32)
    wind = blast(Shape(disc=4.0))
    story = np.stack([np.linalg.norm(feel(wind, place=place, time=t), axis=1) for t in np.arange(0.0, 0.4, 0.02)])
    waves = story - story.mean(axis=0)
    assert waves.std() > 0.02

    def alike(out: int) -> float:
        return float(np.corrcoef(waves[:-1, 60 - out : -60 - out].ravel(), waves[1:, 60:-60].ravel())[0, 1])

    assert alike(12) > alike(0) > alike(-12)


def refusal(text: str, folder: Path | None = None) -> str:
    if folder is not None:
        (folder / "scene.yaml").write_text(text, "utf-8")
    with pytest.raises(SceneError) as error:
        parse_scene(text) if folder is None else read_scene(folder / "scene.yaml")
    (problem,) = error.value.problems
    return f"{problem.line}:{problem.column} {problem.message}"


def test_w9_a_scenes_picture_is_found_beside_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "scenes"
    folder.mkdir()
    pixels = np.zeros((20, 20), np.uint8)
    pixels[4:16, 4:16] = 255
    Image.fromarray(pixels).save(folder / "shape.png")
    (folder / "scene.yaml").write_text(GOOD + "    outline: { image: shape.png, width: 5 }\n", "utf-8")
    monkeypatch.chdir(tmp_path)
    (wind,) = read_scene(folder / "scene.yaml").scene.wind
    assert isinstance(wind, Blast)
    assert wind.outline.outline().deepest == pytest.approx(1.5, abs=0.2)


def test_w9_a_picture_that_is_missing_is_a_problem_at_its_place(tmp_path: Path) -> None:
    told = refusal(GOOD + "    outline:\n      image: shape.png\n", tmp_path)
    assert told.startswith("6:14 no file 'shape.png' relative to the scene")


def test_w9_what_is_no_picture_is_a_problem_at_its_place(tmp_path: Path) -> None:
    (tmp_path / "shape.png").write_text("nothing of the kind")
    assert refusal(GOOD + "    outline: { image: shape.png }\n", tmp_path) == "5:23 'shape.png' is no picture"


def test_w9_of_a_damaged_picture_nothing_is_said_but_its_problem(
    tmp_path: Path, recwarn: pytest.WarningsRecorder
) -> None:
    Image.fromarray(np.zeros((64, 64), np.uint8)).save(tmp_path / "whole.tif")
    (tmp_path / "shape.tif").write_bytes((tmp_path / "whole.tif").read_bytes()[:60])
    assert refusal(GOOD + "    outline: { image: shape.tif }\n", tmp_path) == "5:23 'shape.tif' is no picture"
    assert recwarn.list == []


@pytest.mark.parametrize("grey", [0, 100, 255])
def test_w9_a_picture_without_an_outline_is_a_problem_at_its_place(tmp_path: Path, grey: int) -> None:
    Image.fromarray(np.full((20, 20), grey, np.uint8)).save(tmp_path / "shape.png")
    told = refusal(GOOD + "    outline: { image: shape.png }\n", tmp_path)
    assert told.startswith("5:23 the picture 'shape.png' cannot be used: it must have bright (or opaque) and dark")


@pytest.mark.parametrize(
    ("outline", "told"),
    [
        ("{ disc: 0 }", "5:22 disc must be more than 0.05"),
        ("{ disc: 3, image: a.png }", "5:14 an outline is one of disc, ellipse, polygon and image"),
        ("{ width: 3 }", "5:14 an outline is one of disc, ellipse, polygon and image"),
        ("{ ellipse: [3, 0] }", "5:25 each half axis must be between 0.05 and 1000 m"),
        ("{ ellipse: [3] }", "5:25 ellipse must be"),
        ("{ polygon: [[0, 0], [1, 1]] }", "5:25 polygon must be a list of 3 to 500"),
        ("{ polygon: [[0, 0], [0, 1], [0, 3]] }", "5:25 a polygon must be from 0.05 to 2000 m wide and deep"),
        ("{ polygon: [[0, 0], [1, 1], [3, 3]] }", "5:25 a polygon must hold some ground; this one is too thin"),
        ("{ disk: 3 }", "5:16 unknown key 'disk'"),
    ],
)
def test_w9_an_outline_that_is_none_is_a_problem_at_its_place(outline: str, told: str) -> None:
    assert refusal(GOOD + f"    outline: {outline}\n").startswith(told)


def test_a_shape_made_in_code_is_refused_in_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"^Shape: no file '.*gone\.png'"):
        Shape(image=str(tmp_path / "gone.png"))
    unread = Shape.model_validate({"image": str(tmp_path / "gone.png")}, context={"wind": None})
    with pytest.raises(DeclarationError, match=r"no file '.*gone\.png'"):
        unread.outline()


def test_the_same_outline_is_sampled_once() -> None:
    corners = ((0.0, 0.0), (3.0, 0.0), (0.0, 4.0))
    assert outline_of_polygon(corners) is outline_of_polygon(corners)
    assert Shape(disc=2.0).outline() is Shape(ellipse=[2.0, 2.0]).outline()


@pytest.mark.parametrize("values", [{}, {"disc": 1.0, "ellipse": [1.0, 2.0]}, {"disc": -1.0}, {"round": 3.0}])
def test_a_wrong_outline_is_refused_in_one_sentence(values: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"^Shape: [^\n]+$"):
        Shape(**values)
