"""Options and arguments that several commands take, and functions that parse them."""

import math
from collections.abc import Callable
from functools import partial
from typing import Annotated, TypeVar

import typer

from ..engine.camera import Camera, parse_camera
from ..engine.declared.quality import PresetName
from ..systems.overlay.layers import LAYERS, Layer, parse_layers
from .studio.errors import InputError
from .studio.take import LARGEST, SAMPLES, parse_frames, parse_size

Value = TypeVar("Value")


def bundled(beginning: str) -> list[str]:
    """Return the bundled scenes whose names begin with `beginning`; a shell adds files where there are none."""
    from ..engine.scene import bundled_scenes

    return [name for name in bundled_scenes() if name.startswith(beginning)]


Scene = Annotated[
    str,
    typer.Argument(metavar="SCENE", help="A scene file, or the name of a bundled scene.", autocompletion=bundled),
]
Scenes = Annotated[
    list[str],
    typer.Argument(metavar="SCENE...", help="Scene files, or names of bundled scenes.", autocompletion=bundled),
]
Size = Annotated[str, typer.Option(metavar="WxH", help="Width and height in pixels.")]
Preset = Annotated[PresetName | None, typer.Option(help="Quality preset that replaces the scene's own quality.")]
Reference = Annotated[
    bool, typer.Option("--reference", help="Draw every blade in 3D, supersampled: slow, for comparison.")
]
Laid = Annotated[
    str | None,
    typer.Option("--overlay", metavar="PART,...", help=f"Draw on top how it works: {', '.join(LAYERS)}, or all."),
]
Output = Annotated[str, typer.Option("-o", "--output", help="File or folder to write.")]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
Hold = Annotated[
    float | None,
    typer.Option(min=0.0, max=1000.0, metavar="FPS", help="Frame rate to hold by drawing less; 0 never draws less."),
]
On = Annotated[
    str | None,
    typer.Option(
        metavar="PLACE", help="Share the work among processes: local, local:4, or a Dask scheduler's address."
    ),
]
Edit = Annotated[bool, typer.Option("--edit", help="Edit the scene: in a panel, and on the ground.")]
Fullscreen = Annotated[bool, typer.Option("--fullscreen", help="Fill the screen.")]


def size_of(text: str, /, *, reference: bool = False) -> tuple[int, int]:
    """Return the width and height [pixels] of `--size`; raises InputError, as all of these do."""
    size = _read("--size", parse_size, text)
    if reference and max(size) > LARGEST // SAMPLES:
        raise InputError(f"--size: {text}: with --reference each side must be at most {LARGEST // SAMPLES} pixels")
    return size


def overlay_of(text: str | None, /, *, reference: bool = False) -> frozenset[Layer]:
    """Return the layers of `--overlay`; a reference has none."""
    if text is None:
        return frozenset()
    if reference:
        raise InputError("--overlay: a reference has no levels of detail to show; leave one of the two out")
    return _read("--overlay", parse_layers, text)


def frames_of(text: str | None, /) -> tuple[int, int | None]:
    """Return the first frame of `--frames`, and the one after the last; None is the film's end."""
    return (0, None) if text is None else _read("--frames", parse_frames, text)


def camera_of(text: str, /) -> Camera:
    """Return the camera of `--camera`; its angle of view is left to the scene."""
    return _read("--camera", partial(parse_camera, view=math.radians(40.0)), text)


def _read(option: str, parse: Callable[[str], Value], text: str) -> Value:
    """Return the parsed text of an option; raises InputError for a text that cannot be parsed."""
    try:
        return parse(text)
    except ValueError as error:
        raise InputError(f"{option}: {error}") from None
