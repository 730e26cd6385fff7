"""One field of the panel for one key: a slider, a colour, a choice, a switch, or text."""

from collections.abc import Callable
from typing import Any

from imgui_bundle import imgui

from ...components.colour import hex_of
from ...engine.declared.scene import FORMAT
from ...engine.scene import SceneError
from ...engine.scene.compose import read_document
from .fields import EVERYWHERE, Form, Key, tidied
from .values import NOTHING, yaml_text

WIDE = 1000.0
"""Range above which a slider is too coarse: wider ones are dragged, or get a logarithmic slider."""

LARGEST = 2**31 - 1
"""Largest whole number that a field of imgui takes."""

OWN_NUMBERS = "its own numbers"
"""Label of the choice of a part instead of a text."""

_WIDTH = 170.0


def field(key: Key, value: Any) -> Any:
    """Show the field of a key with its value, and return the new value, or NOTHING if it is unchanged."""
    imgui.set_next_item_width(_WIDTH)
    show = _FIELDS.get(key.form)
    return written(key.name, value) if show is None else show(key, value)


def written(name: str, value: Any) -> Any:
    """Show a field with a value as YAML text, and return the new value, or NOTHING if it is unchanged."""
    before = yaml_text(value)
    entered = _text(name, before)
    if entered is NOTHING or entered == before:
        return NOTHING
    try:
        return read_document(f"tallgrass: {FORMAT}\nvalue: {entered}\n", file="").root.data.get("value")
    except SceneError:
        return entered  # the editor refuses it as a plain text


def _number(key: Key, value: float) -> Any:
    pulled = imgui.is_mouse_down(imgui.MouseButton_.left)
    low, high = key.low, key.high
    number_format = f"%.{5 if abs(value) < 1 else 6}g {key.unit}".rstrip()
    if low is not None and high is not None and (high - low <= WIDE or low > 0.0):
        flags = imgui.SliderFlags_.logarithmic if high - low > WIDE or (low > 0.0 and high / low > WIDE) else 0
        changed, new = imgui.slider_float(f"##{key.name}", value, low, high, number_format, flags)
    else:
        least, most = (low if low is not None else 0.0), (high if high is not None else 0.0)
        changed, new = imgui.drag_float(f"##{key.name}", value, max(abs(value), 1.0) * 0.01, least, most, number_format)
    return tidied(key, new, pulled=pulled) if changed else NOTHING


def _whole(key: Key, value: int) -> Any:
    if abs(value) > LARGEST:
        return written(key.name, value)
    if key.low is not None and key.high is not None and key.high - key.low <= WIDE:
        changed, new = imgui.slider_int(f"##{key.name}", value, int(key.low), int(key.high))
    else:
        changed, new = imgui.input_int(f"##{key.name}", value)
    return int(new) if changed else NOTHING


def _numbers(key: Key, values: list[float]) -> Any:
    pulled = imgui.is_mouse_down(imgui.MouseButton_.left)
    bounded = key.low is not None and key.high is not None and key.high < EVERYWHERE
    least, most = (key.low or 0.0, key.high or 0.0) if bounded else (0.0, 0.0)
    width, gap = _WIDTH / len(values), imgui.get_style().item_inner_spacing.x
    found: Any = NOTHING
    for number, value in enumerate(values):
        if number:
            imgui.same_line(0.0, gap)
        imgui.set_next_item_width(width - gap)
        speed = max(abs(value), 0.5) * 0.01
        changed, new = imgui.drag_float(f"##{key.name}{number}", float(value), speed, least, most, "%.5g")
        if changed:
            found = [*values[:number], tidied(key, new, pulled=pulled), *values[number + 1 :]]
    return found


def _choice(key: Key, value: Any) -> Any:
    choices = [*key.choices, *([OWN_NUMBERS] if key.model is not None else [])]
    now = value if isinstance(value, str) else OWN_NUMBERS
    if not imgui.begin_combo(f"##{key.name}", now):
        return NOTHING
    found: Any = NOTHING
    for each in choices:
        if imgui.selectable(each, each == now)[0] and each != now:
            found = each
    imgui.end_combo()
    return found


def _color(key: Key, value: str) -> Any:
    value = str(hex_of(value))
    parts = [int(value[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    changed, new = imgui.color_edit3(f"##{key.name}", parts, imgui.ColorEditFlags_.display_hex)
    found = "#" + "".join(f"{round(255.0 * min(max(part, 0.0), 1.0)):02x}" for part in list(new)[:3])
    return found if changed and found != value.lower() else NOTHING


def _switch(key: Key, value: bool) -> Any:  # noqa: FBT001 - it is the key's value
    changed, new = imgui.checkbox(f"##{key.name}", value)
    return new if changed else NOTHING


def _text(name: str, value: str) -> Any:
    changed, new = imgui.input_text(f"##{name}", value, imgui.InputTextFlags_.enter_returns_true)
    return new if changed else NOTHING


_FIELDS: dict[Form, Callable[[Key, Any], Any]] = {
    "number": _number,
    "whole": _whole,
    "numbers": _numbers,
    "switch": _switch,
    "choice": _choice,
    "color": _color,
    "text": lambda key, value: _text(key.name, value),
}
