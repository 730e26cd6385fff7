"""The keys of a scene as a tree of fields, derived from the scene's models."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from imgui_bundle import imgui
from pydantic import BaseModel

from ...components.wind import WindPrimitive
from ...engine.declared.grass import GrassKind
from .brush import Brush
from .editor import Editor, Refusal
from .fields import Key, first_part, first_value, item_key, keys_of, tooltip
from .values import NOTHING, Way, value_at
from .widgets import OWN_NUMBERS, written
from .widgets import field as shown_field

Bounds = tuple[float, float, float, float]
"""Left, top, right and bottom of an item, from the window's upper left [pixels]."""

REFUSED = imgui.ImVec4(1.0, 0.45, 0.35, 1.0)
UNSAID = imgui.ImVec4(0.62, 0.66, 0.60, 1.0)
PICKED = imgui.ImVec4(1.0, 0.9, 0.4, 1.0)
"""Text colours of refusals, of keys that the file leaves to their defaults, and of the picked wind."""


@dataclass(slots=True)
class Tree:
    """The fields of an editor's scene."""

    editor: Editor
    kinds: Sequence[str]
    """Names of all kinds of wind."""

    boxes: dict[Way, Bounds] = field(default_factory=dict)
    """Boxes of the keys' fields in the last frame, by way."""

    opened: set[Way] = field(default_factory=set)
    """Ways to the parts that the next frame opens."""

    def show(self) -> None:
        """Show every key of the scene."""
        self.boxes.clear()
        self._keys(self.editor.scene, ())
        self.opened.clear()

    def open(self, way: Way) -> None:
        """Open a part in the next frame, with all parts that enclose it."""
        self.opened |= {way[:count] for count in range(1, len(way) + 1)}

    def _keys(self, part: BaseModel, way: Way) -> None:
        for key in keys_of(type(part)):
            self._key(key, getattr(part, key.name), (*way, key.name))

    def _key(self, key: Key, value: Any, way: Way) -> None:
        if key.form == "fixed":
            return
        imgui.push_id(key.name)
        if key.optional and not self._is_there(key, value, way):
            self._name(key, way)
        elif key.form in ("part", "parts", "named") and value is not None:
            self._branch(key, value, way)
        else:
            self._leaf(key, value, way)
        self._refusal(way)
        imgui.pop_id()

    def _is_there(self, key: Key, value: Any, way: Way) -> bool:
        """Show the switch of an optional key, and return whether the key has a value."""
        changed, on = imgui.checkbox("##there", value is not None)
        self._remember((*way, "there"))
        imgui.set_item_tooltip("whether the scene sets this key")
        if changed and on:
            self.editor.set(way, first_value(key))
        elif changed:
            self.editor.remove(way)
        imgui.same_line()
        return value is not None and not changed

    def _leaf(self, key: Key, value: Any, way: Way) -> None:
        new = shown_field(key, value)
        self._remember(way)
        imgui.same_line()
        self._name(key, way)
        if new is not NOTHING:
            numbers = new == OWN_NUMBERS and key.model is not None
            self.editor.set(way, self.editor.scene.numbers().model_dump() if numbers else new, subject=("field", way))
        if way == ("quality",) and self.editor.prairie.preset is not None:
            imgui.text_colored(UNSAID, "--preset replaces it while you walk")
        if key.model is not None and isinstance(value, BaseModel):
            self._branch(key, value, way)

    def _branch(self, key: Key, value: Any, way: Way) -> None:
        if not self._opened(key, way, key.name):
            return
        if isinstance(value, BaseModel):
            self._keys(value, way)
        elif isinstance(value, dict):
            for name, each in value.items():
                self._item(key, name, each, (*way, name), most=len(value))
            self._add_named(key, value, way)
        else:
            for number, each in enumerate(value):
                self._item(key, str(number + 1), each, (*way, number), most=len(value))
            self._add_part(key, len(value), way)
        imgui.tree_pop()

    def _item(self, key: Key, name: str, part: BaseModel, way: Way, *, most: int) -> None:
        """Show one of several parts, with the actions on the whole part."""
        kind = f"{name} {part.kind}" if isinstance(part, WindPrimitive) else name
        imgui.push_id(name)
        is_picked = isinstance(part, WindPrimitive) and self.editor.picked == way[-1]
        if is_picked:
            imgui.push_style_color(imgui.Col_.text, PICKED)
        opened = self._opened(item_key(key, kind, type(part)), way, f"{kind}###item")
        if is_picked:
            imgui.pop_style_color()
        if isinstance(part, WindPrimitive) and imgui.is_item_clicked():
            self.editor.picked = int(way[-1])
        if opened:
            if isinstance(part, GrassKind) and imgui.small_button("paint where it grows"):
                self.editor.brush = Brush(name)
            if (most > 1 or key.form == "parts") and imgui.small_button("remove"):
                self.editor.remove(way)
            self._keys(part, way)
            imgui.tree_pop()
        self._refusal(way)
        imgui.pop_id()

    def _add_part(self, key: Key, count: int, way: Way) -> None:
        if key.model is None or (key.most is not None and count >= key.most):
            return
        if key.model is not WindPrimitive:
            if imgui.small_button("add one"):
                last = value_at(self.editor.history.now.values, (*way, count - 1))
                self.editor.set((*way, count), first_part(key.model) if last is NOTHING else last)
            return
        imgui.set_next_item_width(110.0)
        if imgui.begin_combo("##add", "add a wind"):
            for kind in self.kinds:
                if imgui.selectable(kind, False)[0]:  # noqa: FBT003 - as imgui has it
                    self.editor.add_wind_of(kind)
            imgui.end_combo()
        self._remember((*way, "add"))

    def _add_named(self, key: Key, value: dict[str, Any], way: Way) -> None:
        if key.model is None or (key.most is not None and len(value) >= key.most):
            return
        imgui.set_next_item_width(110.0)
        entered, name = imgui.input_text_with_hint(
            "##new", "add, by a name", "", imgui.InputTextFlags_.enter_returns_true
        )
        if entered and name and name not in value:
            self.editor.set((*way, name), first_part(key.model))

    def _opened(self, key: Key, way: Way, label: str) -> bool:
        if way in self.opened:
            imgui.set_next_item_open(True)
        opened = imgui.tree_node_ex(label, imgui.TreeNodeFlags_.span_avail_width)
        self._remember(way)
        self._explain(key, way)
        return opened

    def _name(self, key: Key, way: Way) -> None:
        if self.editor.is_said(way):
            imgui.text(key.name)
        else:
            imgui.text_colored(UNSAID, key.name)
        self._explain(key, way)

    def _explain(self, key: Key, way: Way) -> None:
        """Show a key's name with its tooltip; a right click lets its value be edited as text."""
        if key.sentence and imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
            imgui.begin_tooltip()
            imgui.push_text_wrap_pos(360.0)
            imgui.text_unformatted(tooltip(key))
            imgui.pop_text_wrap_pos()
            imgui.end_tooltip()
        if imgui.begin_popup_context_item("as text"):
            said = value_at(self.editor.history.now.values, way)
            imgui.text_unformatted(".".join(str(step) for step in way))
            new = written("text", None if said is NOTHING else said)
            if new is not NOTHING:
                self.editor.set(way, new)
            if said is not NOTHING and key.default is not NOTHING and imgui.menu_item_simple("back to its default"):
                self.editor.remove(way)
            imgui.end_popup()

    def _refusal(self, way: Way) -> None:
        refusal = self.editor.refusal
        if refusal is not None and refusal.way == way:
            show_refusal(refusal)

    def _remember(self, way: Way) -> None:
        self.boxes[way] = last_box()


def last_box() -> Bounds:
    """Return the box of the last item."""
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    return low.x, low.y, high.x, high.y


def show_refusal(refusal: Refusal) -> None:
    """Show the reasons of a refusal."""
    imgui.push_style_color(imgui.Col_.text, REFUSED)
    for reason in refusal.reasons:
        imgui.text_wrapped(reason)
    imgui.pop_style_color()
