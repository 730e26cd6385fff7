"""Options and arguments that several commands take, and what is read from them."""

import math
from typing import Annotated

import typer

from ..engine.camera import Camera, parse_camera
from ..engine.declared.quality import PresetName
from ..systems.overlay.layers import LAYERS, Layer, parse_layers
from .studio.errors import InputError
from .studio.take import LARGEST, SAMPLES, parse_frames, parse_size


def bundled(beginning: str) -> list[str]:
    """Return the bundled scenes whose names begin so; where there are none, a shell goes on with files."""
    from ..engine.scene import bundled_scenes

    return [name for name in bundled_scenes() if name.startswith(beginning)]


Scene = Annotated[
    str,
    typer.Argument(metavar="SCENE", help="A scene file, or the name of a bundled scene.", autocompletion=bundled),
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
    try:
        size = parse_size(text)
    except ValueError as error:
        raise InputError(f"--size: {error}") from None
    if reference and max(size) > LARGEST // SAMPLES:
        raise InputError(f"--size: {text}: with --reference each side must be at most {LARGEST // SAMPLES} pixels")
    return size


def overlay_of(text: str | None, /, *, reference: bool = False) -> frozenset[Layer]:
    """Return the parts of `--overlay`."""
    if text is None:
        return frozenset()
    if reference:
        raise InputError("--overlay: a reference has no levels of detail to show; leave one of the two out")
    try:
        return parse_layers(text)
    except ValueError as error:
        raise InputError(f"--overlay: {error}") from None


def frames_of(text: str | None, /) -> tuple[int, int | None]:
    """Return the first frame of `--frames`, and the one after the last; None is the film's end."""
    try:
        return (0, None) if text is None else parse_frames(text)
    except ValueError as error:
        raise InputError(f"--frames: {error}") from None


def camera_of(text: str, /) -> Camera:
    """Return the camera of `--camera`; its angle of view is left to the scene."""
    try:
        return parse_camera(text, view=math.radians(40.0))
    except ValueError as error:
        raise InputError(f"--camera: {error}") from None
