"""Options and arguments that several commands take, and what is read from them."""

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
    """Return the bundled scenes whose names begin so; where there are none, a shell goes on with files."""
    from ..engine.scene import bundled_scenes

    return [name for name in bundled_scenes() if name.startswith(beginning)]


Scene = Annotated[
    str,
    typer.Argument(metavar="SCENE", help="A scene file, or the name of a bundled scene.", autocompletion=bundled),
]
Scenes = Annotated[
    list[str], typer.Argument(metavar="SCENE...", help="Files or bundled names.", autocompletion=bundled)
]
Size = Annotated[str, typer.Option(metavar="WxH", help="Width and height in pixels.")]
Preset = Annotated[PresetName | None, typer.Option(help="Quality, in place of the scene's own.")]
Reference = Annotated[bool, typer.Option("--reference", help="Draw every blade in 3D, supersampled.")]
Laid = Annotated[
    str | None, typer.Option("--overlay", metavar="PART,...", help=f"Show how it works: {', '.join(LAYERS)}, or all.")
]
Output = Annotated[str, typer.Option("-o", "--output", help="Where it is written.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Hold = Annotated[
    float | None,
    typer.Option(min=0.0, max=1000.0, metavar="FPS", help="Frames a second to hold, by drawing less; 0 draws it all."),
]
On = Annotated[
    str | None,
    typer.Option(metavar="PLACE", help="Let workers do it: local, local:4, or the address of a Dask scheduler."),
]
Edit = Annotated[bool, typer.Option("--edit", help="Change the scene by a panel and on the ground.")]
Fullscreen = Annotated[bool, typer.Option("--fullscreen", help="Fill the screen.")]


def size_of(text: str, /, *, reference: bool = False) -> tuple[int, int]:
    """Return the width and height [pixels] of `--size`; raises InputError, as all of these do."""
    size = _read("--size", parse_size, text)
    if reference and max(size) > LARGEST // SAMPLES:
        raise InputError(f"--size: {text}: with --reference each side must be at most {LARGEST // SAMPLES} pixels")
    return size


def overlay_of(text: str | None, /, *, reference: bool = False) -> frozenset[Layer]:
    """Return the parts of `--overlay`."""
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
    """Return what an option's text says; raises InputError with what is wrong with it."""
    try:
        return parse(text)
    except ValueError as error:
        raise InputError(f"{option}: {error}") from None
