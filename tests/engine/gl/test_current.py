"""The current context and its limits: queried once each, refused in one sentence."""

import ctypes
import importlib.util
import sys
from ctypes import c_int
from types import SimpleNamespace
from typing import Any

import moderngl
import pytest

from tallgrass.engine.gl import functions
from tallgrass.engine.gl.functions import Functions, functions_of_loader
from tallgrass.engine.gl.guest import host_context
from tallgrass.engine.gl.limits import limits_of


def test_a_context_that_is_given_is_taken(ctx: moderngl.Context) -> None:
    assert host_context(ctx) is ctx


def test_drawing_without_a_window_that_is_current_is_refused_in_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    hidden = SimpleNamespace(canvas=object())
    loaded = SimpleNamespace(current_context=hidden, _shadow_window=SimpleNamespace(context=hidden))
    monkeypatch.setitem(sys.modules, "pyglet.gl", loaded)
    monkeypatch.setitem(sys.modules, "pyglet.app", SimpleNamespace(windows=set()))
    with pytest.raises(RuntimeError, match="create the window before the prairie is first drawn"):
        host_context(None)
    monkeypatch.setitem(sys.modules, "pyglet.app", SimpleNamespace(windows={"open"}))
    with pytest.raises(RuntimeError, match=r"^no window is current: call the switch_to of one before the prairie"):
        host_context(None)


@pytest.mark.usefixtures("no_context")
def test_drawing_without_any_context_is_refused_in_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    def none() -> moderngl.Context:
        raise RuntimeError("Cannot detect window with OpenGL support")

    monkeypatch.delitem(sys.modules, "pyglet.gl", raising=False)
    monkeypatch.setattr(moderngl, "get_context", none)
    with pytest.raises(RuntimeError, match=r"^there is no GL context .*create the window before"):
        host_context(None)


@pytest.mark.parametrize(
    ("version", "found"),
    [(b"2.1 Mesa", "OpenGL 2.1"), (b"OpenGL ES 3.2 v1", "OpenGL ES 3.2"), (b"3.2.0", "OpenGL 3.2")],
)
def test_an_opengl_that_is_too_old_is_refused_with_what_to_ask_for(version: bytes, found: str) -> None:
    gl = Functions(SimpleNamespace(load=lambda _: 0))
    gl.__dict__["glGetString"] = lambda _: version
    with pytest.raises(RuntimeError, match=f"context has {found}: ask for version 3.3 and a core profile when the"):
        limits_of(gl)


def test_d6_each_context_has_functions_of_its_own_as_windows_gives_them() -> None:
    class Loader:
        def __init__(self) -> None:
            self.asked: list[str] = []

        def load(self, name: str) -> int:
            self.asked.append(name)
            return ctypes.addressof(c_int())

    loaders = Loader(), Loader()
    one, other = map(functions_of_loader, loaders)
    assert one.glFlush is one.glFlush
    assert one.glFlush is not other.glFlush
    assert [each.asked for each in loaders] == [["glFlush"], ["glFlush"]]


def test_d6_on_windows_gl_is_called_by_its_own_convention(monkeypatch: pytest.MonkeyPatch) -> None:
    def stdcall(answers: Any, *takes: Any) -> Any:
        return lambda address: ("stdcall", answers, takes, address)

    monkeypatch.setattr(ctypes, "WINFUNCTYPE", stdcall, raising=False)
    spec = importlib.util.spec_from_file_location("functions_on_windows", functions.__file__)
    assert spec is not None
    assert spec.loader is not None
    there = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(there)
    assert there.Functions(SimpleNamespace(load=lambda _: 7)).glFlush == ("stdcall", None, (), 7)
