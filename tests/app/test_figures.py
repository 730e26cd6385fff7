"""`tallgrass figures`: every figure is drawn, listed on the page, and shows what its caption says."""

import re
import sys
from collections.abc import Callable, Iterator
from functools import partial
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.quiver import Quiver
from matplotlib.text import Annotation
from numpy.lib.stride_tricks import sliding_window_view
from PIL import Image

from tallgrass.app.cli import run
from tallgrass.app.figures import bending
from tallgrass.app.figures.bending import STIFFNESS, draw_postures, draw_responses, extreme, gust_profile, kinds
from tallgrass.app.figures.figure import Detail
from tallgrass.app.figures.page import index_page
from tallgrass.app.figures.patch import draw_edges, edges, on_strip, painted, sample
from tallgrass.app.figures.plot import Panel, look, plate, put_on_paper
from tallgrass.app.figures.quality import ROWS, draw_presets
from tallgrass.app.figures.register import FIGURES
from tallgrass.app.figures.tiling import CULLED, draw_tiling
from tallgrass.app.figures.walk import draw_walk, walk_frames
from tallgrass.app.figures.wind import draw_fields, draw_masks, grid, patch_weights, windless
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow.response import grow_response
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.whirlwind import Whirlwind

SMALL = Detail(size=(96, 54), preset="low", dots=360)
FEW = ("--size", "96x54", "--preset", "low")


@pytest.fixture(autouse=True, scope="module")
def _simulated_once() -> Iterator[None]:
    """Share simulations between figures and tests: most kinds are in several of them."""
    with pytest.MonkeyPatch.context() as patch:
        for name in ("grow_response", "grow_postures", "grow_give"):
            patch.setattr(bending, name, _remembered(getattr(bending, name)))
        yield


def _remembered(grow: Callable[..., Any]) -> Callable[..., Any]:
    told: dict[str, Any] = {}

    def grown(kind: GrassKind, **options: Any) -> Any:
        key = f"{kind!r} {options}"
        if key not in told:
            told[key] = grow(kind, **options)
        return told[key]

    return grown


class Page(HTMLParser):
    """Collects a page's links and its text."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.ids: list[str] = []
        self.text = ""
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        told = dict(attrs)
        self.targets += [target for key in ("href", "src") if (target := told.get(key))]
        self.ids += [name for key in ("id",) if (name := told.get(key))]

    def handle_data(self, data: str) -> None:
        self.text += data


def drawn(figure: Figure) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    figure.canvas.draw()
    return np.asarray(figure.canvas.buffer_rgba())  # type: ignore[attr-defined]


@pytest.fixture
def _narrow(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the command draw plots of the size `SMALL`."""
    monkeypatch.setattr("tallgrass.app.figures.figure.Detail", partial(Detail, dots=SMALL.dots))


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx", "_coarse", "_narrow")
def test_every_figure_is_drawn_and_the_page_shows_all_of_them(tmp_path: Path) -> None:
    folder = tmp_path / "deep" / "figures"
    assert run(["figures", "-o", str(folder), *FEW]) == 0
    page = Page((folder / "index.html").read_text("utf-8"))
    for target in page.targets:
        assert target[1:] in page.ids if target.startswith("#") else (folder / target).is_file(), target
    for each in FIGURES:
        assert each.file in page.targets
        assert f"Figure {each.number}: {each.title}." in page.text
        assert each.shows in page.text
        with Image.open(folder / each.file) as image:
            assert np.asarray(image.convert("L")).std() > 5
            assert image.info["Title"] == f"Figure {each.number}: {each.title}"
    assert {path.name for path in folder.iterdir()} == {"index.html", *(each.file for each in FIGURES)}


def test_the_paper_figures_are_told_of_in_order_and_once() -> None:
    numbers = [each.number for each in FIGURES]
    assert numbers == list(range(2, 18))
    for each in FIGURES:
        assert each.shows.endswith(".")
        assert each.made.endswith(".")


@pytest.mark.slow
@pytest.mark.usefixtures("_narrow")
def test_some_figures_are_drawn_alone_and_join_what_is_there(tmp_path: Path) -> None:
    assert run(["figures", "-o", str(tmp_path), "--only", " 10, 6"]) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"index.html", "figure-06.png", "figure-10.png"}
    first = (tmp_path / "figure-10.png").read_bytes()
    assert run(["figures", "-o", str(tmp_path), "--only", "7"]) == 0
    page = Page((tmp_path / "index.html").read_text("utf-8"))
    assert [target for target in page.targets if target.endswith(".png")][::2] == [
        "figure-06.png", "figure-07.png", "figure-10.png",
    ]  # fmt: skip
    assert (tmp_path / "figure-10.png").read_bytes() == first


def test_n5_a_figure_is_the_same_file_again_whatever_the_readers_own_style(tmp_path: Path) -> None:
    with look():
        put_on_paper(draw_masks(SMALL), tmp_path / "a.png", title="masks")
    with mpl.rc_context({"lines.linewidth": 9.0, "axes.facecolor": "red"}), look():
        put_on_paper(draw_masks(SMALL), tmp_path / "b.png", title="masks")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


@pytest.mark.parametrize("only", ["99", "x", "6,", "", "6;8", "-6"])
def test_a_number_that_is_no_figure_is_told_with_those_there_are(
    only: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["figures", "-o", str(tmp_path), f"--only={only}"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("--only: ")
    assert ", ".join(str(each.number) for each in FIGURES) in said
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_a_file_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "taken").write_text("")
    assert run(["figures", "-o", str(tmp_path / "taken"), "--only", "6"]) == 2
    assert re.fullmatch(r"-o: .*taken: is a file, not a folder\n", capsys.readouterr().err)


def test_without_matplotlib_a_sentence_says_what_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert run(["figures", "-o", str(tmp_path)]) == 1
    assert capsys.readouterr().err.strip() == "figures are drawn by Matplotlib: pip install 'tallgrass[figures]'"


@pytest.mark.gl
@pytest.mark.usefixtures("ctx", "_coarse")
def test_g3_a_strip_in_figure_3_bends_like_blades_and_carries_what_is_painted_on_it() -> None:
    one = sample(SMALL)
    message = np.array([[0.0, 0.0], [0.4, 0.2], [-0.7, 0.5]], np.float32)
    edge = edges(one, message, points=40)
    lengths = np.linalg.norm(np.diff(edge, axis=1), axis=2).sum(axis=1)
    np.testing.assert_allclose(lengths, one.strips.height, rtol=2e-3)
    grid_of = np.stack(np.meshgrid(np.linspace(0, 1, 3), np.linspace(0, 1, 40), indexing="ij"), axis=-1)
    np.testing.assert_allclose(on_strip(edge, grid_of.astype(np.float32)), edge, atol=1e-5)
    rest = edges(one, np.zeros((3, 2), np.float32), points=2)
    at = one.targets[0, :1]
    place = on_strip(rest, at)[0]
    wide = one.quality.patch + 2 * one.strips.margin
    np.testing.assert_allclose(place[:, 0], at[0, :, 0] * wide - one.strips.margin, atol=1e-5)
    np.testing.assert_allclose(place[:, 1], at[0, :, 1] * one.strips.height, atol=1e-5)
    with look():
        assert [axes.get_title("left") for axes in draw_edges(SMALL).axes] == ["a)  at rest", "b)  in the wind"]


@pytest.mark.gl
@pytest.mark.usefixtures("ctx", "_coarse")
def test_g3_the_strip_of_figure_4_is_as_opaque_as_its_texels_are_covered() -> None:
    one = sample(SMALL)
    texels = one.strips.texels[0, 0]
    picture = painted(one, texels)
    np.testing.assert_allclose(picture[..., 3] * 255.0, texels[..., 3])
    assert ((picture >= 0.0) & (picture <= 1.0)).all()
    covered = texels[..., 3] > 128
    assert (picture[..., 1] > picture[..., 2])[covered].mean() > 0.95, "grass is greener than blue"


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx", "_coarse")
def test_t2_figure_5_colours_the_patches_in_the_view_cone_alone() -> None:
    with look():
        (axes,) = draw_tiling(SMALL).axes
    (tiles,) = (each for each in axes.collections if isinstance(each, PolyCollection))
    cone = next(each for each in axes.patches if isinstance(each, Polygon)).get_xy()
    apex, rays = cone[1], np.stack([cone[0] - cone[1], cone[2] - cone[1]])
    middle = np.array([np.asarray(path.vertices, float)[:4].mean(axis=0) for path in tiles.get_paths()]) - apex
    culled = np.isclose(np.asarray(tiles.get_facecolor())[:, :3], CULLED).all(axis=1)
    ahead = rays[0] / np.linalg.norm(rays[0]) + rays[1] / np.linalg.norm(rays[1])
    ahead /= np.linalg.norm(ahead)
    half = np.arccos(ahead @ rays[0] / np.linalg.norm(rays[0]))
    off = np.arccos(np.clip(middle @ ahead / np.linalg.norm(middle, axis=1), -1.0, 1.0))
    far = np.linalg.norm(middle, axis=1) > 10.0
    assert 0.02 < (~culled).mean() < 0.5
    assert not culled[far & (off < half)].any()
    assert culled[far & (off > half + 0.5)].all()


def test_w3_the_blades_of_figure_6_have_the_lengths_of_their_kinds() -> None:
    with look():
        figure = draw_postures(SMALL)
    for axes, kind in zip(figure.axes[:3], kinds().values(), strict=True):
        length = sum(kind.height) / 2
        tips = axes.lines[0].get_xydata()
        assert f"{length:.2f} m" in axes.get_title("left")
        assert np.hypot(*np.asarray(tips).T).max() == pytest.approx(length, rel=1e-3)


def test_w12_in_figure_6_the_stiffest_blades_stand_highest_in_the_same_wind() -> None:
    with look():
        figure = draw_postures(SMALL)
    told = [[text for text in axes.texts if text.get_text() == "+1"] for axes in figure.axes[3:]]
    tips = [text.xy[1] for (text,) in told if isinstance(text, Annotation)]
    assert len(tips) == len(STIFFNESS)
    # Less than blades that taper evenly: broad tips catch more wind.
    assert tips[-1] > max(tips[:-1]) + 0.22 * 0.6


def test_w4_figure_8_plots_the_response_of_each_kind() -> None:
    with look():
        start, stop, _ = draw_responses(SMALL).axes
    for name, kind in kinds().items():
        response = grow_response(kind)
        for axes, curve, rest in ((start, response.rise, 1.0), (stop, response.fall, 0.0)):
            line = next(line for line in axes.lines if str(line.get_label()).startswith(f"{name}: "))
            np.testing.assert_array_equal(line.get_ydata(), curve)
            np.testing.assert_allclose(np.array(line.get_xdata(), float), response.step * np.arange(len(curve)))
            peak = extreme(response, curve, rest=rest)
            assert peak.index == (curve.max() if rest else curve.min())
            assert str(line.get_label()).endswith(f"{abs(peak.index):.2f} at {peak.time:.2f} s")


def test_w6_the_profile_of_a_gust_is_the_response_read_along_its_way() -> None:
    response = grow_response(kinds()["barley"])
    gust = Gust(speed=8.0, hold=4.0, tail=3.0, strength=0.5, ragged=0.0)
    elapsed = np.linspace(0.0, 3.5, 50, dtype=np.float32)
    expected = 0.5 * np.interp(elapsed, response.step * np.arange(len(response.rise)), response.rise)
    np.testing.assert_allclose(gust_profile(response, gust, 8.0 * elapsed), expected, atol=2e-3)
    assert gust_profile(response, gust, np.array([-0.1, -5.0], np.float32)).tolist() == [0.0, 0.0]


def test_figure_7_weighs_patches_by_the_ground_that_a_mask_holds() -> None:
    prairie = windless()
    prairie.add(Whirlwind(radius=6.0, soft=0.0))
    (wind,) = prairie.winds.acting(1.0)
    middle = grid((-10.0, 10.0), (-10.0, 10.0), 2.5)
    weight = patch_weights(wind, middle, patch=2.5, time=1.0)
    prairie.release()
    away = np.hypot(*middle.T)
    assert (weight[away < 6.0 - 1.8] == 1.0).all()
    assert (weight[away > 6.0 + 1.8] == 0.0).all()
    assert weight.sum() * 2.5**2 == pytest.approx(np.pi * 36.0, rel=0.03)


def test_figure_10_names_every_built_in_wind_and_draws_its_arrows() -> None:
    with look():
        figure = draw_fields(SMALL)
    panels = figure.axes[:4]
    assert [axes.get_title("left")[4:] for axes in panels] == ["breeze", "gust", "whirlwind", "blast"]
    for axes in panels:
        (arrows,) = (each for each in axes.collections if isinstance(each, Quiver))
        assert np.size(arrows.U) > 40
        assert np.hypot(arrows.U, arrows.V).max() <= 1.0 + 1e-6


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx", "_coarse")
def test_r1_figure_16_shows_every_preset_with_its_blades_and_its_cost_in_frames_of_high() -> None:
    with look():
        told = [text.get_text() for text in draw_presets(SMALL).texts]
    pattern = re.compile(r"([a-z-]+): ([0-9]+)k blades, cost ([0-9.]+)")
    found = [match.groups() for text in told if (match := pattern.fullmatch(text))]
    assert [name for name, _, _ in found] == [name for row in ROWS for name in row]
    blades = {name: int(count) for name, count, _ in found}
    assert blades["high"] == pytest.approx(2 * blades["low"], abs=2)
    assert {name: float(cost) for name, _, cost in found}["high"] == 1.0


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx", "_coarse")
def test_x1_figure_17_shows_a_walk_before_amid_and_after_changes() -> None:
    with look():
        told = [text.get_text() for text in draw_walk(SMALL).texts]
    assert [text[:2] for text in told[:2]] == ["a)", "b)"]
    assert len(told) == 8
    (first, levels, _), (later, _, changing) = walk_frames(SMALL, (7.7, 8.0))
    assert (first != later).any()
    assert (first != levels).any()
    assert changing > 0


def test_rendered_pictures_are_put_on_paper_pixel_for_pixel() -> None:
    random = np.random.default_rng(3)
    pictures = random.integers(0, 256, (2, 20, 60, 3)).astype(np.uint8)
    with look():
        page = drawn(plate([[Panel(picture, "text") for picture in pictures]]))[..., :3]
    for picture in pictures:
        windows = sliding_window_view(page, picture.shape)
        assert (windows == picture).all(axis=(3, 4, 5)).sum() == 1


def test_the_page_needs_nothing_from_elsewhere_and_escapes_what_it_says() -> None:
    html = index_page(FIGURES)
    assert not re.search(r"https?://|//[a-z]|@import|url\(", html)
    assert "prefers-color-scheme: dark" in html
    assert html.count("<figure ") == len(FIGURES)
