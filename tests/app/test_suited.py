"""Preset and frame rate that suit the machine of a walk (N11)."""

import sys

import moderngl
import pytest

from tallgrass.app import display
from tallgrass.app.display import no_window, suited_preset
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


LACKING = AttributeError("'NoneType' object has no attribute 'XRenderFindVisualFormat'")


@pytest.mark.parametrize(
    ("platform", "displays", "why"),
    [
        ("linux", {}, "there is no display"),
        ("linux", {"DISPLAY": ""}, "there is no display"),
        ("linux", {"DISPLAY": ":0"}, str(LACKING)),
        ("linux", {"WAYLAND_DISPLAY": "wayland-0"}, str(LACKING)),
        ("darwin", {}, str(LACKING)),
    ],
)
def test_without_a_display_that_is_why_no_window_opens_whatever_else_fails(
    monkeypatch: pytest.MonkeyPatch, platform: str, displays: dict[str, str], why: str
) -> None:
    monkeypatch.setattr(sys, "platform", platform)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    for name, value in displays.items():
        monkeypatch.setenv(name, value)
    assert f"({why})" in no_window(LACKING)
