"""Forwarding of pyglet's mouse and key events to Dear ImGui."""

from imgui_bundle import imgui
from pyglet.window import key, mouse

_NAMED = {
    key.TAB: "tab", key.BACKSPACE: "backspace", key.RETURN: "enter", key.ESCAPE: "escape", key.INSERT: "insert",
    key.DELETE: "delete", key.SPACE: "space", key.LEFT: "left_arrow", key.RIGHT: "right_arrow", key.UP: "up_arrow",
    key.DOWN: "down_arrow", key.HOME: "home", key.END: "end", key.PAGEUP: "page_up", key.PAGEDOWN: "page_down",
    key.NUM_ENTER: "keypad_enter",
}  # fmt: skip
_LETTERS = {getattr(key, letter.upper()): letter for letter in "acvxyz"}
KEYS = {symbol: getattr(imgui.Key, name) for symbol, name in (_NAMED | _LETTERS).items()}
"""Keys of a text field, by pyglet's code; letters only for shortcuts with Ctrl."""

MODIFIERS = (
    (key.MOD_CTRL, imgui.Key.mod_ctrl),
    (key.MOD_SHIFT, imgui.Key.mod_shift),
    (key.MOD_ALT, imgui.Key.mod_alt),
    (key.MOD_COMMAND, imgui.Key.mod_super),
)
OWN = {
    key.LCTRL: key.MOD_CTRL, key.RCTRL: key.MOD_CTRL, key.LSHIFT: key.MOD_SHIFT, key.RSHIFT: key.MOD_SHIFT,
    key.LALT: key.MOD_ALT, key.RALT: key.MOD_ALT, key.LCOMMAND: key.MOD_COMMAND, key.RCOMMAND: key.MOD_COMMAND,
}  # fmt: skip
"""Dear ImGui's keys for the modifier keys, by pyglet's code."""

BUTTONS = {mouse.LEFT: 0, mouse.RIGHT: 1, mouse.MIDDLE: 2}


def tell_key(symbol: int, modifiers: int, *, down: bool) -> None:
    """Forward a key that was pressed or released, and the modifiers held with it."""
    own = OWN.get(symbol, 0)  # pyglet reports the modifiers held before this key
    tell_modifiers(modifiers | own if down else modifiers & ~own)
    if symbol in KEYS:
        imgui.get_io().add_key_event(KEYS[symbol], down)


def tell_modifiers(modifiers: int) -> None:
    """Forward the held modifiers, such as Ctrl and Shift."""
    io = imgui.get_io()
    for bit, named in MODIFIERS:
        io.add_key_event(named, bool(modifiers & bit))


def tell_text(text: str) -> None:
    """Forward typed text."""
    imgui.get_io().add_input_characters_utf8(text)


def tell_mouse(x: float, y: float) -> None:
    """Forward the position of the pointer, counted from the window's lower left [pixels]."""
    io = imgui.get_io()
    io.add_mouse_pos_event(x, io.display_size.y - y)


def tell_button(button: int, modifiers: int, *, down: bool) -> None:
    """Forward a mouse button that was pressed or released."""
    tell_modifiers(modifiers)
    if button in BUTTONS:
        imgui.get_io().add_mouse_button_event(BUTTONS[button], down)


def let_go() -> None:
    """Release every key and button: another window takes over, which is told of their releases."""
    io = imgui.get_io()
    io.clear_input_keys()
    io.clear_input_mouse()


def tell_wheel(x: float, y: float) -> None:
    """Forward a turn of the wheel."""
    imgui.get_io().add_mouse_wheel_event(x, y)
