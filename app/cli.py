"""The command `tallgrass`: the arguments of its commands, and their exit status.

Every command exits with 0 on success, with 2 on bad input (one line per problem), and with 1 on a failure of its own.
"""

import os
import signal
import sys
from io import TextIOWrapper
from typing import Annotated, NoReturn

import typer

from .. import __version__
from ..engine.declared.quality import LodName
from .bench.commands import bench
from .options import (
    Edit,
    Fullscreen,
    Hold,
    Json,
    Laid,
    On,
    Output,
    Preset,
    Reference,
    Scene,
    Scenes,
    Size,
    camera_of,
    frames_of,
    overlay_of,
    size_of,
)
from .studio.errors import InputError, MachineError
from .studio.take import Take

app = typer.Typer(
    help="Grow, animate and draw whole prairies in real time.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
app.add_typer(bench, name="bench")
plugins = typer.Typer(
    help="List and check winds and systems of installed packages, or begin a wind of your own.", no_args_is_help=True
)
app.add_typer(plugins, name="plugins")
begin = typer.Typer(help="Begin a game, or a wind of your own.", no_args_is_help=True)
app.add_typer(begin, name="new")


def main() -> None:
    """Run the command line and leave Python with its exit status.

    On SIGTERM it removes half-written files, and exits with 143.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):  # a character that a terminal lacks shows as `\u8349`
            stream.reconfigure(errors="backslashreplace")
    asked: list[int] = []

    def end(number: int, _: object) -> NoReturn:
        asked.append(128 + number)
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, end)
    status = run(sys.argv[1:])
    sys.exit(asked[0] if asked else status)


def run(arguments: list[str], /) -> int:
    """Run one command and return its exit status; errors go to standard error, without a traceback.

    With `TALLGRASS_TRACEBACK` in the environment, unexpected errors keep theirs.
    """
    try:
        status = typer.main.get_command(app).main(arguments, prog_name="tallgrass", standalone_mode=False)
        return int(status or 0)
    except typer.TyperException as error:
        # typer has the words of pydantic, which speaks of an input
        return _tell(error.format_message().replace("Value error, ", "").replace("Input should", "it has to"), status=2)
    except typer.Abort:
        return _tell("stopped", status=130)
    except InputError as error:
        return _tell(str(error), status=2)
    except MachineError as error:
        return _tell(str(error), status=1)
    except Exception as error:  # noqa: BLE001 - any error is told in one sentence
        return _unexpected(error)


@app.command()
def walk(
    scene: Scene = "meadow",
    size: Size = "1280x720",
    preset: Preset = None,
    *,
    fullscreen: Fullscreen = False,
    seconds: Annotated[
        float | None, typer.Option(min=0.1, max=36000.0, help="Close by itself after so many seconds.")
    ] = None,
    overlay: Laid = None,
    hold: Hold = None,
    edit: Edit = False,
) -> None:
    """Walk through a scene in a window; F1 shows the keys.

    Holds 60 frames a second, or 20 without a graphics card, by drawing fewer pixels and less distant grass.
    With --edit you change the scene while you walk, and save it into its file.
    """
    take = Take(scene, size_of(size), preset, overlay=overlay_of(overlay))
    from .walk import walk_in

    walk_in(take, fullscreen=fullscreen, seconds=seconds, hold=hold, edit=edit)


@app.command()
def shot(
    output: Output,
    scene: Scene = "meadow",
    time: Annotated[float, typer.Option(min=0.0, max=36000.0, help="Time of the scene, in seconds.")] = 0.0,
    size: Size = "1280x720",
    preset: Preset = None,
    lod: Annotated[LodName, typer.Option(help="One representation for all grass, or auto: by distance.")] = "auto",
    *,
    reference: Reference = False,
    camera: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z,YAW,PITCH",
            help="Camera in metres and degrees; Y is a height in the scene, not above ground.",
        ),
    ] = None,
    overlay: Laid = None,
) -> None:
    """Draw one picture, without a window."""
    laid = overlay_of(overlay, reference=reference)
    take = Take(scene, size_of(size, reference=reference), preset, lod, reference, laid)
    place = None if camera is None else camera_of(camera)
    from .shot import shot

    shot(take, output, time=time, camera=place)


@app.command()
def film(
    output: Output,
    scene: Scene = "meadow",
    seconds: Annotated[
        float | None, typer.Option(min=0.0, max=36000.0, help="Seconds of film; by default those of the camera's path.")
    ] = None,
    fps: Annotated[int, typer.Option(min=1, max=120, help="Frames per second.")] = 24,
    size: Size = "640x360",
    preset: Preset = None,
    *,
    reference: Reference = False,
    overlay: Laid = None,
    frames: Annotated[str | None, typer.Option(metavar="A:B", help="Only frames A to B - 1 of the film.")] = None,
    on: On = None,
) -> None:
    """Film a scene along its camera's path, without a window: .webp, .gif, .mp4, or a folder of pictures."""
    span = frames_of(frames)
    laid = overlay_of(overlay, reference=reference)
    take = Take(scene, size_of(size, reference=reference), preset, reference=reference, overlay=laid)
    from .film import film

    film(take, output, seconds=seconds, fps=fps, frames=span, on=on)


@app.command()
def check(scenes: Scenes) -> int:
    """Validate scenes, and print every problem of each."""
    from .check import check

    return check(scenes)


@app.command()
def grow(scenes: Scenes, preset: Preset = None, on: On = None) -> None:
    """Grow the grass of scenes in advance, so that they open at once."""
    from .grow import grow

    grow(scenes, preset=preset, on=on)


@app.command()
def figures(
    output: Output,
    only: Annotated[str | None, typer.Option(metavar="N,...", help="Only these figures, such as 6,8.")] = None,
    size: Size = "960x540",
    preset: Preset = None,
) -> None:
    """Draw the figures of the paper that tallgrass follows into a folder, and a page index.html that shows them."""
    pixels = size_of(size)
    from .figures.make import make_figures

    make_figures(output, only=only, size=pixels, preset=preset)


@app.command()
def schema() -> None:
    """Print the JSON Schema of scene files, for editors; it includes installed winds.

    Save it as FILE. A language server for YAML finds it by a comment in a scene: # yaml-language-server: $schema=FILE
    """
    from .check import schema

    schema()


@app.command()
def doctor() -> int:
    """Check packages, OpenGL, windows and winds on this machine; for each missing thing, print how to install it."""
    from .doctor import doctor

    return doctor()


@plugins.command("list")
def list_(*, json: Json = False) -> None:
    """List winds and installed systems, each with its package, and whether another package claims its name."""
    from .plugins import list_plugins

    list_plugins(json=json)


@plugins.command("check")
def check_(name: Annotated[str, typer.Argument(metavar="NAME", help="The kind of wind, as scenes call it.")]) -> int:
    """Check a kind of wind: its fields, and what it computes all along its timeline."""
    from .plugins import check_plugin

    return check_plugin(name)


Folder = Annotated[str | None, typer.Option("-o", "--output", help="Folder to make; by default NAME.")]
WindName = Annotated[str, typer.Argument(metavar="NAME", help="The kind of wind, as scenes will call it.")]


@plugins.command("new")
@begin.command("wind")
def wind(name: WindName, output: Folder = None) -> None:
    """Begin a wind of your own: an installable package with one kind of wind that works, and its test."""
    from .scaffold import new_wind

    new_wind(name, output)


@begin.command("game")
def game(
    name: Annotated[str, typer.Argument(metavar="NAME", help="The game's name, also its window's title.")],
    output: Folder = None,
) -> None:
    """Begin a game: a walk through a prairie with a gust on a key, a pause, a choice of quality, and a test."""
    from .scaffold import new_game

    new_game(name, output)


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
