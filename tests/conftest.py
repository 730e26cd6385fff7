"""Fixtures of all tests: numpy errors raise; one headless GL context, a private world, a display, a cache."""

import ctypes
import gc
import json
import os
import shutil
import subprocess
import sys
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from copy import copy
from functools import lru_cache
from pathlib import Path
from typing import Any, NoReturn

import moderngl
import numpy as np
import pytest
from hypothesis import settings
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.quality import Quality
from tallgrass.engine.kept import cache_folder
from tallgrass.engine.world import World
from tallgrass.systems import holding, site
from tallgrass.systems.around.receivers import Receiving
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.light import repeating
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.stock import cache
from tallgrass.systems.stock.cache import cached_growth, growth_key
from tallgrass.testing import NoContextError, headless_context, private_world

# The oldest supported OpenGL, so that no test uses anything newer; only Mesa reads these.
os.environ.setdefault("MESA_GL_VERSION_OVERRIDE", "3.3FC")
os.environ.setdefault("MESA_GLSL_VERSION_OVERRIDE", "330")

# Pictures in tests are small: Mesa's software rasteriser would optimise a program for longer than it draws with it.
# Pixels are the same.
os.environ.setdefault("GALLIVM_PERF", "nopt")

# The same examples on every machine, with no limit of time.
settings.register_profile("tallgrass", deadline=None, derandomize=True, max_examples=25)
settings.load_profile("tallgrass")

Python = Callable[..., str]
OnCard = list[tuple[Receiving, NDArray[np.float32]]]

REMEMBERED, KEPT = 24, 2 << 30
"""Number of growths kept in memory, of a few megabytes each, and room for them in the cache [bytes]."""

PROGRAMS = 40
"""Number of released programs kept for the next prairie; each takes 5 MB in a software rasteriser."""

SEEDS = 64
"""Number of seeds whose ground and clouds are kept, less than a megabyte each."""

QUICK = "test_drawing_twice_at_the_same_time_gives_the_same_picture"
SLOW_FOLDERS = "app", "docs", "examples", "hosts", "packaging"
"""The only test of a quick run that draws, and the folders of `tests` that a quick run leaves out."""

PARENT = Path(__file__).with_name("parent_program.py")
"""Program that imports what all programs import, and forks to run each of them."""

LITTLE_GRASS = """
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.quality import PRESETS, StripRing
from tallgrass.systems.stock import models


def _grow_little(mechanics=models.mechanics_of(GrassKind()), postures=models._postures):
    models.mechanics_of, models._postures = lambda _: mechanics, lambda *_: postures(mechanics, 0)
    rings = [StripRing(to=8, strips=2, columns=1, sections=1, texel=0.03)]
    small = PRESETS["low"].model_copy(update={"blades": 40, "models": 1, "strip_rings": rings, "carpet": 16})
    PRESETS.update(dict.fromkeys(PRESETS, small))


_grow_little()
"""
"""Code that makes a program's grass grow in a moment: all presets are coarse, and all kinds bend alike."""

_HOME = pytest.StashKey[moderngl.Framebuffer]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option `--quick`, for a run of less than a minute."""
    parser.addoption(
        "--quick", action="store_true", help="only quick tests: of engine, systems and scenes, and one picture"
    )


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out `SLOW_FOLDERS`, whose tests start programs, in a quick run."""
    return True if config.option.quick and collection_path.name in SLOW_FOLDERS else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark tests that draw, and run those that open windows last: a window takes the current GL context away.

    Tests marked `hosts` or `slow` are left out unless `-m` names the mark.
    """
    for mark in ("hosts", "slow"):
        if mark not in config.option.markexpr:
            items[:] = [item for item in items if item.get_closest_marker(mark) is None]
    for item in items:
        if "ctx" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.gl)
    if config.option.quick:
        drawn = "gl", "window", "golden"
        items[:] = [item for item in items if QUICK in item.name or not any(map(item.get_closest_marker, drawn))]
    items.sort(key=lambda item: item.get_closest_marker("window") is not None)


def pytest_collection_finish() -> None:
    """Exclude all objects made until now from garbage collection, which would go through them again and again."""
    gc.collect()
    gc.freeze()
    gc.collect()  # the number of objects in this one decides when the next full collection is due


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Make the shared context and its framebuffer current again: an earlier test may have left others."""
    _come_home(item)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_teardown(item: pytest.Item) -> None:
    """Make them current for the release of fixtures, too: in another context nothing would be released."""
    _come_home(item)


def _come_home(item: pytest.Item) -> None:
    if _HOME in item.config.stash and "ctx" in getattr(item, "fixturenames", ()):
        home = item.config.stash[_HOME]
        home.ctx.__enter__()  # type: ignore[no-untyped-call]
        home.use()


def _do_without(reason: str) -> NoReturn:
    """Skip a test that cannot run on this machine; with TALLGRASS_REQUIRE_GL=1, fail it."""
    if os.environ.get("TALLGRASS_REQUIRE_GL") == "1":
        pytest.fail(f"TALLGRASS_REQUIRE_GL=1, but {reason}")
    pytest.skip(reason)


@pytest.fixture(autouse=True)
def _numbers_fail_loudly() -> Iterator[None]:
    # Exponentials may underflow to zero.
    with np.errstate(divide="raise", over="raise", invalid="raise", under="ignore"):
        yield


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Grow into a cache of the tests' own, which parallel workers share; the user's cache stays as it is.

    If Python writes no bytecode beside sources, bytecode goes into a folder here: programs that tests start would spend
    more than half of their time compiling the same modules again.
    """
    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TALLGRASS_CACHE", str(folder / "cache"))
        if sys.dont_write_bytecode and "PYTHONPYCACHEPREFIX" not in os.environ:
            patch.delenv("PYTHONDONTWRITEBYTECODE", raising=False)
            patch.setenv("PYTHONPYCACHEPREFIX", str(folder / "bytecode"))
        yield
    if sys.pycache_prefix is not None:  # bytecode of the tests' own folder is of no use later
        shutil.rmtree(Path(sys.pycache_prefix, *folder.parts[1:]), ignore_errors=True)


@pytest.fixture(scope="session", autouse=True)
def _grown_once() -> Iterator[None]:
    """Keep the last growths in memory: reading one from the cache takes longer than many tests."""
    grown: OrderedDict[tuple[Path | None, str], Growth] = OrderedDict()

    def remembered(kind: GrassKind, quality: Quality, /, *, seed: int) -> Growth:
        key = cache_folder(), growth_key(kind, quality, seed=seed)
        if key not in grown:
            grown[key] = cached_growth(kind, quality, seed=seed)
        grown.move_to_end(key)
        if len(grown) > REMEMBERED:
            grown.popitem(last=False)
        return grown[key]

    levels = lru_cache(SEEDS)(repeating.repeating_levels.__wrapped__)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(site, "cached_growth", remembered)
        patch.setattr(cache, "ROOM", KEPT)
        patch.setattr(repeating, "repeating_levels", levels)
        yield


@pytest.fixture(scope="session", autouse=True)
def _programs_as_they_are_drawn() -> Iterator[None]:
    """Compile programs when first drawn, as films do: compiling all that a game needs takes longer than most tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(holding, "AHEAD", False)
        yield


class _Programs:
    """Pool of released programs of the shared context; a prairie that asks for an equal program gets one of them.

    Its uniforms are reset to their first values. The driver would take longer to read a program from its cache than to
    draw a small picture with it, and tens of prairies ask for each program, one after another.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx, self._free = ctx, OrderedDict[tuple[Any, ...], tuple[moderngl.Program, dict[str, Any]]]()
        self._lent: dict[int, tuple[tuple[Any, ...], dict[str, Any]]] = {}
        self._make, self._release = moderngl.Context.program, moderngl.Program.release

    def lend(self, ctx: moderngl.Context, *shaders: Any, **how: Any) -> moderngl.Program:
        """Return a program from the pool, or else make it."""
        if ctx is not self._ctx or shaders or not how.keys() <= {"vertex_shader", "fragment_shader", "varyings"}:
            return self._make(ctx, *shaders, **how)
        key = how["vertex_shader"], how.get("fragment_shader"), tuple(how.get("varyings", ()))
        if key in self._free:
            made, values = self._free.pop(key)
            for name, value in values.items():
                made[name] = value
        else:
            made = self._make(ctx, **how)
            values = {name: each.value for name in made if isinstance(each := made[name], moderngl.Uniform)}
        self._lent[id(made)] = key, values
        return made

    def take_back(self, program: moderngl.Program) -> None:
        """Put a released program into the pool, as a copy: using the released object is still an error."""
        key, values = self._lent.pop(id(program), (None, {}))
        if key is None or key in self._free:
            self._release(program)
            return
        self._free[key] = copy(program), values
        program.mglo = moderngl.InvalidObject()
        if len(self._free) > PROGRAMS:
            self._release(self._free.popitem(last=False)[1][0])


@pytest.fixture
def ahead(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compile all programs before the first frame, as a game does."""
    monkeypatch.setattr(holding, "AHEAD", True)


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw nothing: a software rasteriser compiles most of a program when it first draws with it."""
    for name in ("render", "transform"):
        monkeypatch.setattr(moderngl.VertexArray, name, lambda *_, **__: None)


@pytest.fixture(scope="session")
def ctx(pytestconfig: pytest.Config) -> Iterator[moderngl.Context]:
    """Headless GL context that all tests draw in."""
    with ExitStack() as stack:
        try:
            context = stack.enter_context(headless_context())
        except NoContextError as error:
            _do_without(str(error))
        pytestconfig.stash[_HOME] = context.fbo
        programs, patch = _Programs(context), stack.enter_context(pytest.MonkeyPatch.context())
        patch.setattr(moderngl.Context, "program", lambda *given, **how: programs.lend(*given, **how))  # noqa: PLW0108 - a function becomes a method
        patch.setattr(moderngl.Program, "release", lambda program: programs.take_back(program))  # noqa: PLW0108 - as above
        yield context


@pytest.fixture(autouse=True)
def _gl_is_left_without_errors(request: pytest.FixtureRequest) -> Iterator[None]:
    yield
    if "ctx" in request.fixturenames:
        context = request.getfixturevalue("ctx")
        context.__enter__()  # never left: modules release their fixtures in it later
        assert context.error == "GL_NO_ERROR"


@pytest.fixture(scope="session")
def on_card() -> Callable[[Prairie], OnCard]:
    """Return the function that reads the receivers of blades and strips of the last frame from the graphics card.

    It returns for each pool, and each receiver of the patches shown: message, height of the ground, and density of the
    receiver's kind, shape (patches, receivers, 4).
    """

    def read(prairie: Prairie) -> OnCard:
        drawn_by, outlook = prairie.painter, prairie.viewers["main"]
        assert drawn_by is not None
        counts = {name: each.receivers(outlook) for name, each in drawn_by.painters.items()}
        numbers = iter(drawn_by.received.allocate([count for each in counts.values() for count in each]))
        texels = np.frombuffer(drawn_by.received.texture.read(), np.float32).reshape(-1, 4)
        found: OnCard = []
        for name, each in counts.items():
            for receiving, count, first in zip(outlook.kept[name].receiving, each, numbers, strict=False):
                if not receiving.still:
                    shape = len(receiving.slots), int(np.prod(receiving.pool.shape)), 4
                    found.append((receiving, texels[first : first + count].reshape(shape)))
        return found

    return read


@pytest.fixture
def world() -> Iterator[World]:
    """World of a prairie in an esper world that no other test sees."""
    with private_world() as made:
        yield made


@pytest.fixture(scope="session")
def python(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Python]:
    """Return the function that runs a program in a process of its own: `python(folder, name, *arguments)`.

    It returns the program's output. `place` is added to the environment; the code `before` runs first. Modules that all
    programs import are imported already.
    """
    output = tmp_path_factory.mktemp("python") / "output"
    command = [sys.executable, "-W", "error", "-W", "ignore:This process:DeprecationWarning", str(PARENT)]
    ours = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    with subprocess.Popen(command, env=ours, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdin is not None
        assert parent.stdout is not None

        def run(folder: Path, program: str, *arguments: str, place: dict[str, str], before: str = "") -> str:
            told = {
                "folder": str(folder), "program": program, "arguments": arguments, "place": place, "before": before,
                "output": str(output),
            }  # fmt: skip
            print(json.dumps(told), file=parent.stdin, flush=True)
            status, said = parent.stdout.readline(), output.read_text("utf-8")  # type: ignore[union-attr]
            assert status == "0\n", f"{program}\n{said}"
            return said

        yield run
        parent.stdin.close()


@pytest.fixture(scope="session")
def little_grass() -> str:
    """Code to run `before` a program, so that its grass grows in a moment."""
    return LITTLE_GRASS


@pytest.fixture(scope="session")
def _xvfb() -> Iterator[str]:
    program = shutil.which("Xvfb")
    if program is None:
        _do_without("there is neither a display nor Xvfb (apt-get install --no-install-recommends xvfb xauth)")
    command = [program, "-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        assert server.stdout is not None
        yield f":{server.stdout.readline().strip()}"
        server.terminate()


@pytest.fixture(scope="session")
def display(request: pytest.FixtureRequest) -> str:
    """Name of a display for windows: the environment's, or that of an Xvfb of the tests' own."""
    name = os.environ.get("DISPLAY") or request.getfixturevalue("_xvfb")
    os.environ["DISPLAY"] = name
    return name


@pytest.fixture(autouse=True)
def _windows_have_a_display(request: pytest.FixtureRequest) -> None:
    if request.node.get_closest_marker("window") is not None:
        request.getfixturevalue("display")
        _let_the_headless_context_go()


@pytest.fixture
def no_context() -> None:
    """Make no GL context current in this thread, whatever ran before."""
    _let_the_headless_context_go()


def _let_the_headless_context_go() -> None:
    """Make no GL context current in this thread: a window cannot replace a context of EGL."""
    try:
        egl = ctypes.CDLL("libEGL.so.1")
    except OSError:
        return
    egl.eglGetCurrentDisplay.restype = ctypes.c_void_p
    egl.eglMakeCurrent.argtypes = [ctypes.c_void_p] * 4
    screen = egl.eglGetCurrentDisplay()
    if screen is not None:
        egl.eglMakeCurrent(screen, None, None, None)
