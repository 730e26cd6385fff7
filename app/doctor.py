"""Diagnosis of this machine, with the exact command that installs each missing thing."""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import EntryPoint, PackageNotFoundError, entry_points, requires, version
from typing import Literal

from ..engine.gl.rasteriser import is_software
from ..engine.installed import OURS
from ..engine.plugins import GROUP, NewerError, PluginError, WindKinds, wind_kinds
from .shell import command_line

_DISTRIBUTION = "tallgrass"
_EXTRA = re.compile(r"extra\s*==\s*.(\w+)")
_NEEDED_BY = {
    "bench": "bench picture, bench pop and bench all",
    "edit": "walks with --edit",
    "farm": "films on many machines",
    "figures": "figures and bench all",
    "video": "films in .mp4",
}
_NEWER_DRIVER = "update the graphics driver"
_OR_SOFTWARE = f"{_NEWER_DRIVER}, or draw in software: LIBGL_ALWAYS_SOFTWARE=1"

_OTHER_CURES = (
    (r"externally-managed-environment", "python3 -m venv .venv && .venv/bin/pip install '.[commands]'"),
    (r"eglCreateContext failed|Could not create GL context|OpenGL version", _OR_SOFTWARE),
)

_DEBIAN_PACKAGES = (
    (r"libGL\S* not (found|loaded)|library libGL|Library \"GL\"", "libegl1 libgl1"),
    (r"libEGL\S* not (found|loaded)|Library \"EGL\"", "libegl1"),
    (r"found 0 devices", "libegl-mesa0 libgl1-mesa-dri"),
    (r"eglInitialize failed|NoSuchConfigException", "libgl1-mesa-dri"),
    (r"Library \"(freetype|fontconfig)\"", "libfontconfig1 libfreetype6"),
    (r"XRenderFindVisualFormat", "libxrender1"),
    (r"Library \"X11\"|libX11\S* not (found|loaded)", "libx11-6"),
    (r"cannot open display|NoSuchDisplayException|Cannot connect to", "xvfb xauth"),
    (r"ensurepip is not available|No module named '?ensurepip", "python3-venv"),
)


@dataclass(frozen=True, slots=True)
class Finding:
    """The result of one check."""

    part: str
    """Subject of the check: `python`, a package, `OpenGL`, `window`, or a kind of wind."""

    level: Literal["ok", "note", "missing"]
    """`missing` keeps prairies from being drawn or walked; a `note` does not."""

    text: str
    """Result in words."""

    cure: str | None = None
    """Command or advice that mends it."""


def doctor() -> int:
    """Print what this machine has and lacks; return 0 if a prairie can be drawn here, and 1 if not."""
    return tell(diagnose())


def diagnose() -> list[Finding]:
    """Check Python, packages, OpenGL, windows and wind plugins; return the findings."""
    installed = [*entry_points(group=GROUP)]
    has_display = not _has_packages() or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    return [
        Finding("python", "ok", f"{sys.version.split()[0]} ({sys.executable})"),
        *packages(requires(_DISTRIBUTION) or []),
        drawing(_probe("draw")),
        window(_probe("window"), has_display=has_display),
        *winds(wind_kinds(), installed),
    ]


def tell(findings: Sequence[Finding]) -> int:
    """Print findings, each with its cure below; return the exit status: 1 if something is missing."""
    for finding in findings:
        print(f"{finding.level:8}{finding.part}: {finding.text}")
        if finding.cure is not None:
            print(f"{'':8}-> {finding.cure}")
    missing = [finding.part for finding in findings if finding.level == "missing"]
    print(f"missing: {', '.join(missing)}" if missing else "a prairie can be drawn here")
    return 1 if missing else 0


def cure(message: str, /) -> str | None:
    """Return the cure for an error message of a loader, a driver or an installer; None for an unknown one.

    It is a command where packages exist; on Windows and macOS it is advice to update the driver.
    """
    for pattern, line in _OTHER_CURES:
        if re.search(pattern, message):
            return _NEWER_DRIVER if line == _OR_SOFTWARE and not _has_packages() else line
    if not _has_packages():
        return _NEWER_DRIVER if re.search("GL", message) else None
    return next((_debian(names) for pattern, names in _DEBIAN_PACKAGES if re.search(pattern, message)), None)


def packages(requirements: Sequence[str], /) -> list[Finding]:
    """Return a finding for each of `requirements`, which are written as in a distribution's metadata."""
    findings = []
    for requirement in requirements:
        need, _, marker = (part.strip() for part in requirement.partition(";"))
        extra = _EXTRA.search(marker)
        if extra is None:
            findings.append(_package(need, "missing", "not installed"))
        elif extra[1] in _NEEDED_BY:
            findings.append(_package(need, "note", f"not installed; only {_NEEDED_BY[extra[1]]} need it"))
    return findings


def _package(need: str, otherwise: Literal["note", "missing"], text: str) -> Finding:
    name = re.split(r"[^\w.-]", need, maxsplit=1)[0]
    try:
        return Finding(name, "ok", version(name))
    except PackageNotFoundError:
        return Finding(name, otherwise, text, _pip(need))


def drawing(answer: dict[str, str], /) -> Finding:
    """Return the finding from the answer of the headless OpenGL probe."""
    if "error" in answer:
        return Finding("OpenGL", "missing", answer["error"], cure(answer["error"]))
    text = "{version}, {renderer}, {vendor}".format(**answer)
    if is_software(answer["renderer"]):
        return Finding("OpenGL", "note", f"{text}; a software rasteriser draws right, but slowly")
    return Finding("OpenGL", "ok", text)


def window(answer: dict[str, str], /, *, has_display: bool) -> Finding:
    """Return the finding from the answer of the window probe; films and pictures need no display."""
    if "error" not in answer:
        return Finding("window", "ok", "{version}, {renderer}".format(**answer))
    if has_display:
        return Finding("window", "missing", answer["error"], cure(answer["error"]))
    run = "xvfb-run -a tallgrass walk"
    virtual = run if shutil.which("xvfb-run") else f"{_debian('xvfb xauth')} && {run}"
    return Finding("window", "note", "there is no display: films and pictures only", virtual)


def winds(kinds: WindKinds, entries: Sequence[EntryPoint], /) -> list[Finding]:
    """Return findings on the kinds of wind; a broken kind affects only the scenes that use it."""
    installed = sorted(entries, key=lambda entry: entry.dist is not None and entry.dist.name == OURS)
    owner = {entry.name: entry.dist.name for entry in installed if entry.dist is not None}  # ours last: they win
    findings = []
    for kind in kinds.names():
        name = owner.get(kind, "the game")
        try:
            kinds.find(kind)
        except PluginError as error:
            # A newer version may mend a package's own faults; for a missing module, the error text is enough.
            lacks = isinstance(error.__cause__, ModuleNotFoundError)
            newer = "tallgrass" if isinstance(error, NewerError) else name
            mended = _pip(newer) if kind in owner and not lacks else None
            findings.append(Finding(f"wind {kind}", "note", str(error), mended))
        else:
            findings.append(Finding(f"wind {kind}", "ok", f"from {name}"))
    return findings


def _pip(requirement: str) -> str:
    return command_line([sys.executable, "-m", "pip", "install", "--upgrade", requirement])


def _debian(names: str) -> str:
    if shutil.which("apt-get") is None:
        return f"install what Debian calls {names}"
    root = "" if hasattr(os, "geteuid") and os.geteuid() == 0 else "sudo "
    return f"{root}apt-get install -y --no-install-recommends {names}"


def _has_packages() -> bool:
    """Return whether this system has packages for OpenGL and windows, as Linux does."""
    return sys.platform not in {"darwin", "win32"}


def _probe(name: str) -> dict[str, str]:
    """Run a probe in a process of its own, as a broken driver may crash it, and return its answer."""
    command = [sys.executable, "-P", "-m", __name__, name]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)  # noqa: S603 - our own
    except subprocess.TimeoutExpired:
        return {"error": "no answer within two minutes"}
    try:
        answer: dict[str, str] = json.loads(run.stdout)
    except ValueError:
        last = run.stderr.strip().splitlines()[-1:]
        return {"error": f"it crashed with status {run.returncode}: {''.join(last)}"}
    return answer


def _draw_once() -> dict[str, str]:
    from .studio.offscreen import standalone_context

    info = standalone_context().info
    return {"version": info["GL_VERSION"], "renderer": info["GL_RENDERER"], "vendor": info["GL_VENDOR"]}


def _open_window_once() -> dict[str, str]:
    import pyglet

    shown = pyglet.window.Window(64, 64, visible=False)
    pyglet.text.Label("grass").draw()
    info = shown.context.get_info()
    shown.close()
    return {"version": info.get_version_string(), "renderer": info.get_renderer()}


_PROBES: dict[str, Callable[[], dict[str, str]]] = {"draw": _draw_once, "window": _open_window_once}


def _answer(name: str) -> dict[str, str]:
    try:
        return _PROBES[name]()
    except Exception as error:  # noqa: BLE001 - whatever goes wrong is the answer
        return {"error": f"{type(error).__name__}: {error}"}


if __name__ == "__main__":
    print(json.dumps(_answer(sys.argv[1])))
