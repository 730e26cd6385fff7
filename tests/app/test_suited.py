"""Preset and frame rate that suit the machine of a walk (N11)."""

import moderngl
import pytest

from tallgrass.app import display
from tallgrass.app.display import suited_preset
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.engine.declared.scene import Scene
from tallgrass.engine.gl.rasteriser import is_software


@pytest.mark.parametrize(("quality", "drawn_by", "preset"), [
    ("high", "llvmpipe", "low"),
    ("paper-low", "llvmpipe", "low"),
    ("low", "llvmpipe", None),
    ("minimal", "llvmpipe", None),
    (PRESETS["high"], "llvmpipe", None),
    ("high", "a card", None),
])  # fmt: skip
def test_without_a_card_a_finer_preset_is_walked_in_as_low(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch, quality: object, drawn_by: str, preset: str | None
) -> None:
    monkeypatch.setattr(display, "draws_in_software", lambda _: is_software(drawn_by))
    scene = Scene.model_validate({"tallgrass": 2, "grass": {"grass": {}}, "quality": quality})
    assert suited_preset(scene, ctx) == preset
