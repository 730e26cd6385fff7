"""The command `tallgrass`: what each of its commands takes, and how it ends.

Every command exits with 0 on success, with 2 on bad input (one line per problem), and with 1 on a failure of its own.
"""

import math
import os
import signal
import sys
from typing import Annotated, NoReturn

import typer

from .. import __version__
from ..engine.camera import Camera, parse_camera
from ..engine.declared.scene import LodName, PresetName
from ..systems.overlay.layers import LAYERS, Layer, parse_layers
from .studio.errors import InputError, MachineError
from .studio.take import LARGEST, SAMPLES, Take, parse_frames, parse_size

app = typer.Typer(
    help="Grow, animate and draw whole prairies in real time.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
bench = typer.Typer(help="Measure: what frames take, how true they are, and whether they pop.", no_args_is_help=True)
app.add_typer(bench, name="bench")
plugins = typer.Typer(help="Kinds of wind and systems that other packages bring.", no_args_is_help=True)
app.add_typer(plugins, name="plugins")


def _bundled(beginning: str) -> list[str]:
    """Return the bundled scenes whose names begin so; where there are none, a shell goes on with files."""
    from ..engine.scene import bundled_scenes

    return [name for name in bundled_scenes() if name.startswith(beginning)]


Scene = Annotated[
    str,
    typer.Argument(metavar="SCENE", help="A scene file, or the name of a bundled scene.", autocompletion=_bundled),
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
Fullscreen = Annotated[bool, typer.Option("--fullscreen", help="Fill the screen.")]


def main() -> None:
    """Run the command line and leave Python with its exit status.

    Asked to end, as by `kill`, it takes away what is half written, and exits with 143.
    """
    asked: list[int] = []

    def end(number: int, _: object) -> NoReturn:
        asked.append(128 + number)
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, end)
    status = run(sys.argv[1:])
    sys.exit(asked[0] if asked else status)


def run(arguments: list[str], /) -> int:
    """Run one command and return its exit status; what went wrong is told on standard error, without a traceback.

    With `TALLGRASS_TRACEBACK` in the environment, failures of our own keep theirs.
    """
    try:
        status = typer.main.get_command(app).main(arguments, prog_name="tallgrass", standalone_mode=False)
        return int(status or 0)
    except typer.TyperException as error:
        return _tell(error.format_message().replace("Value error, ", ""), status=2)
    except typer.Abort:
        return _tell("stopped", status=130)
    except InputError as error:
        return _tell(str(error), status=2)
    except MachineError as error:
        return _tell(str(error), status=1)
    except Exception as error:  # noqa: BLE001 - whatever it is, it gets a sentence
        return _unexpected(error)


@app.command()
def walk(
    scene: Scene = "meadow",
    size: Size = "1280x720",
    preset: Preset = None,
    *,
    fullscreen: Fullscreen = False,
    seconds: Annotated[float | None, typer.Option(min=0.1, max=36000.0, help="Close by itself after so long.")] = None,
    overlay: Laid = None,
    hold: Hold = None,
) -> None:
    """Walk through a scene in a window; F1 shows the keys.

    60 frames a second are held, and 20 where there is no graphics card: what takes too long is drawn with fewer pixels.
    """
    take = Take(scene, _size(size), preset, overlay=_overlay(overlay))
    from .display import need_display

    need_display()
    from .window import walk_in

    walk_in(take, fullscreen=fullscreen, seconds=seconds, hold=hold)


@app.command()
def shot(
    output: Output,
    scene: Scene = "meadow",
    time: Annotated[float, typer.Option(min=0.0, max=36000.0, help="Instant of the scene, in seconds.")] = 0.0,
    size: Size = "1280x720",
    preset: Preset = None,
    lod: Annotated[LodName, typer.Option(help="Representation, the same one everywhere unless auto.")] = "auto",
    *,
    reference: Reference = False,
    camera: Annotated[str | None, typer.Option(metavar="X,Y,Z,YAW,PITCH", help="Metres and degrees.")] = None,
    overlay: Laid = None,
) -> None:
    """Draw one picture, without a window."""
    laid = _overlay(overlay, reference=reference)
    take = Take(scene, _size(size, reference=reference), preset, lod, reference, laid)
    place = None if camera is None else _camera(camera)
    from .shot import shot

    shot(take, output, time=time, camera=place)


@app.command()
def film(
    output: Output,
    scene: Scene = "meadow",
    seconds: Annotated[float | None, typer.Option(min=0.0, max=36000.0, help="How long it lasts.")] = None,
    fps: Annotated[int, typer.Option(min=1, max=120, help="Frames per second.")] = 24,
    size: Size = "640x360",
    preset: Preset = None,
    *,
    reference: Reference = False,
    overlay: Laid = None,
    frames: Annotated[
        str | None, typer.Option(metavar="A:B", help="Only frame A to the one before B of the whole film.")
    ] = None,
    on: On = None,
) -> None:
    """Film a scene along its camera's path, without a window: .webp, .gif, .mp4, or a folder of pictures."""
    span = _frames(frames)
    laid = _overlay(overlay, reference=reference)
    take = Take(scene, _size(size, reference=reference), preset, reference=reference, overlay=laid)
    from .film import film

    film(take, output, seconds=seconds, fps=fps, frames=span, on=on)


@app.command()
def check(
    scenes: Annotated[
        list[str], typer.Argument(metavar="SCENE...", help="Files or bundled names.", autocompletion=_bundled)
    ],
) -> int:
    """Validate scenes, and tell every problem of each."""
    from .check import check

    return check(scenes)


@app.command()
def figures(
    output: Output,
    only: Annotated[str | None, typer.Option(metavar="N,...", help="Numbers of some figures, as 6,8.")] = None,
    size: Size = "960x540",
    preset: Preset = None,
) -> None:
    """Draw the figures of the paper into a folder, with a page index.html that shows them."""
    pixels = _size(size)
    from .figures.make import make_figures

    make_figures(output, only=only, size=pixels, preset=preset)


@app.command()
def schema() -> None:
    """Print the JSON Schema of scene files, installed plugins included, for an editor.

    A language server for YAML finds it by a comment anywhere in a scene: # yaml-language-server: $schema=FILE
    """
    from .schema import schema

    schema()


@app.command()
def doctor() -> int:
    """Tell what this machine has, and for each thing missing the line that installs it."""
    from .doctor import doctor

    return doctor()


@bench.command("frame")
def frame(
    scene: Scene = "meadow",
    preset: Preset = None,
    size: Size = "1280x720",
    *,
    json: Json = False,
    viewers: Annotated[int, typer.Option(min=1, max=16, help="Viewers in every frame, side by side.")] = 1,
) -> int:
    """Measure how long a frame takes, and what it is made of."""
    pixels = _size(size)
    from .bench.frame import bench_frame

    return bench_frame(scene, preset=preset, size=pixels, json=json, viewers=viewers)


@bench.command("picture")
def picture(
    scene: Annotated[
        str, typer.Argument(metavar="SCENE", help="A scene file, a bundled scene, or a folder.")
    ] = "meadow",
    preset: Preset = None,
    size: Size = "1280x720",
    *,
    json: Json = False,
    output: Annotated[str | None, typer.Option("-o", "--output", help="A folder for pictures with references.")] = None,
) -> int:
    """Measure how far a picture is from every blade in 3D, supersampled; of a folder, those of all its scenes."""
    pixels = _size(size)
    from .bench.picture import bench_picture

    return bench_picture(scene, preset=preset, size=pixels, json=json, output=output)


@bench.command("pop")
def pop(
    scene: Scene = "meadow",
    preset: Preset = None,
    size: Size = "640x360",
    *,
    json: Json = False,
    parts: Annotated[bool, typer.Option("--parts", help="Also leave out each part of the transitions alone.")] = False,
    output: Annotated[str | None, typer.Option("-o", "--output", help="A folder for pictures of what shows.")] = None,
    hold: Hold = None,
) -> int:
    """Measure whether a change of representation can be seen on a walk; this takes minutes."""
    pixels = _size(size)
    from .bench.pop import bench_pop

    return bench_pop(scene, preset=preset, size=pixels, json=json, parts=parts, output=output, hold=hold)


@plugins.command("list")
def list_(*, json: Json = False) -> None:
    """Tell every kind of wind and every installed system, who brings it, and whether it can be used."""
    from .plugins import list_plugins

    list_plugins(json=json)


@plugins.command("check")
def check_(name: Annotated[str, typer.Argument(metavar="NAME", help="A kind of wind.")]) -> int:
    """Tell every problem of a kind of wind: its fields, and what it answers all along its timeline."""
    from .plugins import check_plugin

    return check_plugin(name)


@plugins.command("new")
def new(
    name: Annotated[str, typer.Argument(metavar="NAME", help="The kind of wind, as scenes will call it.")],
    output: Annotated[str | None, typer.Option("-o", "--output", help="A new folder; by default NAME.")] = None,
) -> None:
    """Begin a plugin: an installable package with one kind of wind that works, and its test."""
    from .plugins import new_plugin

    new_plugin(name, output)


@bench.command("walk")
def bench_walk(scene: Scene = "meadow", preset: Preset = None, size: Size = "1280x720", *, json: Json = False) -> int:
    """Measure whether frames keep taking the same time on a walk."""
    pixels = _size(size)
    from .bench.walk import bench_walk

    return bench_walk(scene, preset=preset, size=pixels, json=json)


@bench.command("scale")
def scale(scene: Scene = "meadow", preset: Preset = None, size: Size = "1280x720", *, json: Json = False) -> int:
    """Measure what a larger terrain costs, up to 10 km."""
    pixels = _size(size)
    from .bench.scale import bench_scale

    return bench_scale(scene, preset=preset, size=pixels, json=json)


def _print_version(wanted: bool) -> None:  # noqa: FBT001 - typer passes it by place
    if wanted:
        print(f"tallgrass {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    *,
    version: Annotated[
        bool, typer.Option("--version", is_eager=True, callback=_print_version, help="Print the version.")
    ] = False,
) -> None:
    pass


def _size(text: str, *, reference: bool = False) -> tuple[int, int]:
    try:
        size = parse_size(text)
    except ValueError as error:
        raise InputError(f"--size: {error}") from None
    if reference and max(size) > LARGEST // SAMPLES:
        raise InputError(f"--size: {text}: with --reference each side must be at most {LARGEST // SAMPLES} pixels")
    return size


def _overlay(text: str | None, *, reference: bool = False) -> frozenset[Layer]:
    if text is None:
        return frozenset()
    if reference:
        raise InputError("--overlay: a reference has no levels of detail to show; leave one of the two out")
    try:
        return parse_layers(text)
    except ValueError as error:
        raise InputError(f"--overlay: {error}") from None


def _frames(text: str | None) -> tuple[int, int | None]:
    try:
        return (0, None) if text is None else parse_frames(text)
    except ValueError as error:
        raise InputError(f"--frames: {error}") from None


def _camera(text: str) -> Camera:
    try:
        return parse_camera(text, view=math.radians(40.0))
    except ValueError as error:
        raise InputError(f"--camera: {error}") from None


def _tell(text: str, *, status: int) -> int:
    if text:
        print(text, file=sys.stderr)
    return status


def _unexpected(error: Exception) -> int:
    from ..engine.scene import SceneError

    if isinstance(error, SceneError):
        lines = [str(problem) if sys.stderr.isatty() else str(problem).splitlines()[0] for problem in error.problems]
        return _tell("\n".join(lines), status=2)
    if "TALLGRASS_TRACEBACK" in os.environ:
        raise error
    what = str(error).splitlines()[0] if str(error) else "no more is known"
    return _tell(f"tallgrass failed: {type(error).__name__}: {what} (tallgrass doctor may know why)", status=1)


if __name__ == "__main__":
    main()
