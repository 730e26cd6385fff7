"""Every key of a scene in the panel, those of a stranger's wind too."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from pydantic import BaseModel, Field

from tallgrass.app.edit.fields import keys_of
from tallgrass.app.edit.values import Way
from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Extent, Grass, WindPrimitive
from tallgrass.engine.plugins import WindKinds, wind_kinds
from tallgrass.engine.scene import bundled_scenes
from tallgrass.systems.wind.placed import PlacedWind

from .driving import SCENE, drag, field, frames, opened, strike

if TYPE_CHECKING:
    from tallgrass.app.edit.window import EditWalk

pytest.importorskip("imgui_bundle", reason="the panel is drawn by imgui-bundle, of the extra 'edit'")
pytestmark = [pytest.mark.window, pytest.mark.gl]


def test_n13_every_key_of_a_scene_has_its_field(walk: "EditWalk", tmp_path: Path) -> None:
    walk.window.set_size(720, 1000)
    text = bundled_scenes()["storm"].read_text().replace("quality: high", SCENE[SCENE.index("quality:") :])
    (tmp_path / "lawn.yaml").write_text(text.replace("[200, 200]", "[100, 100]"))
    walk.editor.read_again()
    parts = dict(parts_of(walk.editor.scene))
    assert len(parts) > 30
    opened(walk, *filter(None, parts))
    shown = set(walk.panel.tree.boxes)
    for way, part in parts.items():
        for key in keys_of(type(part)) if isinstance(part, BaseModel) else ():
            if key.form != "fixed":
                assert {(*way, key.name), (*way, key.name, "there")} & shown, (*way, key.name)


def parts_of(value: Any, way: Way = ()) -> Iterator[tuple[Way, Any]]:
    """Yield each part of a scene that can be opened in the panel, models and lists of models, with its way."""
    if isinstance(value, BaseModel):
        inner: list[tuple[str | int, Any]] = [(key.name, getattr(value, key.name)) for key in keys_of(type(value))]
    elif isinstance(value, dict):
        inner = list(value.items())
    elif isinstance(value, list) and value and isinstance(value[0], BaseModel):
        inner = list(enumerate(value))
    else:
        return
    yield way, value
    for step, each in inner:
        yield from parts_of(each, (*way, step))


class Draught(PlacedWind):
    """A plugin's wind."""

    kind: str = "draught"
    """A draught."""

    chill: float = Field(default=2.0, ge=0.0, le=8.0)
    """How cold it is [degrees]."""

    holes: int = Field(default=3, ge=1)
    """Number of holes that it comes through."""

    leaves: int = Field(default=10**12, ge=0)
    """Number of leaves that it moves."""

    def extent(self, *, time: float) -> Extent:
        return Extent(-2.0, 2.0, -2.0, 2.0)

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.full((len(place), 2), 0.2, np.float32)


def test_n13_a_strangers_wind_is_added_where_one_looks_and_has_its_fields(
    walk: "EditWalk", own_kinds: WindKinds, tmp_path: Path
) -> None:
    own_kinds.add("draught", Draught)
    assert walk.editor.add_wind_of("draught")
    frames(walk, 3)
    wind = walk.prairie.scene.wind[1]
    assert isinstance(wind, Draught)
    assert walk.editor.picked_wind is wind
    assert wind.position == pytest.approx(walk.editor.spot, abs=0.01)
    drag(walk, field(walk, ("wind", 1, "chill"), 0.25), field(walk, ("wind", 1, "chill"), 0.75))
    drag(walk, field(walk, ("wind", 1, "holes"), 0.97))  # the button that counts on
    blown = walk.prairie.scene.wind[1].model_dump()
    assert (blown["chill"], blown["holes"]) == (pytest.approx(6.0, abs=0.5), 4)
    strike(walk, "S", ctrl=True)
    added = [line for line in (tmp_path / "lawn.yaml").read_text().splitlines() if line not in SCENE.splitlines()]
    (line,) = added
    assert line.startswith("  - { kind: draught, position: [")


class Broken(Draught):
    """A plugin's wind that fails."""

    kind: str = "broken"
    """A broken one."""

    def parts(self, *, time: float, seed: int) -> Sequence[WindPrimitive]:
        raise RuntimeError("no parts")


def test_a_strangers_wind_that_fails_is_added_and_left_out(walk: "EditWalk", own_kinds: WindKinds) -> None:
    own_kinds.add("broken", Broken)
    assert walk.editor.add_wind_of("broken")
    frames(walk, 2)
    assert walk.editor.picked == 1
    assert [*walk.prairie.wind_failures.values()] == ["wind[1] broken: parts raised RuntimeError: no parts"]


@pytest.fixture
def own_kinds() -> Iterator[WindKinds]:
    wind_kinds.cache_clear()
    yield wind_kinds()
    wind_kinds.cache_clear()
