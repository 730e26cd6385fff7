"""The commands of `tallgrass bench` and their arguments."""

from typing import Annotated

import typer

from ..options import Hold, Json, On, Output, Preset, Scene, Size, bundled, size_of
from ..studio.take import Take

Scenes = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        help="A scene file, the name of a bundled scene, or a folder of scenes.",
        autocompletion=bundled,
    ),
]

bench = typer.Typer(
    help="Measure frame times, how close pictures are to every blade in 3D, and whether anything pops.",
    no_args_is_help=True,
)


@bench.command("frame")
def frame(
    scene: Scene = "meadow",
    preset: Preset = None,
    size: Size = "1280x720",
    *,
    json: Json = False,
    viewers: Annotated[int, typer.Option(min=1, max=16, help="Number of viewers in each frame, side by side.")] = 1,
) -> None:
    """Measure how long a frame takes, and each part of it."""
    take = Take(scene, size_of(size), preset)
    from .frame import frame_measured
    from .machine import tell

    tell(frame_measured(take, viewers=viewers), as_json=json)


@bench.command("picture")
def picture(
    scene: Scenes = "meadow",
    preset: Preset = None,
    size: Size = "1280x720",
    *,
    json: Json = False,
    output: Annotated[
        str | None, typer.Option("-o", "--output", help="Folder for the pictures and their references.")
    ] = None,
    on: On = None,
) -> None:
    """Measure how far a picture is from a reference with every blade in 3D; takes a folder of scenes, too."""
    take = Take(scene, size_of(size), preset)
    from .many import bench_many
    from .picture import SURVEY

    bench_many(take, SURVEY, json=json, output=output, on=on)


@bench.command("pop")
def pop(
    scene: Scenes = "meadow",
    preset: Preset = None,
    size: Size = "640x360",
    *,
    json: Json = False,
    parts: Annotated[
        bool, typer.Option("--parts", help="Also measure walks without each part of the transitions.")
    ] = False,
    output: Annotated[
        str | None, typer.Option("-o", "--output", help="Folder for pictures of the worst frames.")
    ] = None,
    hold: Hold = None,
    climb: Annotated[
        bool, typer.Option("--climb", help="Climb up to 60 m instead of walking, and then look straight down.")
    ] = False,
    on: On = None,
) -> None:
    """Measure whether changes of representation can be seen on a walk; takes a folder of scenes, too."""
    take = Take(scene, size_of(size), preset)
    from .many import bench_many
    from .pop import must_be_large, pop_survey

    must_be_large(take.size)
    bench_many(take, pop_survey(parts=parts, hold=hold, rising=climb), json=json, output=output, on=on)


@bench.command("walk")
def walk(scene: Scene = "meadow", preset: Preset = None, size: Size = "1280x720", *, json: Json = False) -> None:
    """Measure how even frame times are on a walk."""
    take = Take(scene, size_of(size), preset)
    from .machine import tell
    from .walk import walk_measured

    tell(walk_measured(take), as_json=json)


@bench.command("scale")
def scale(
    scene: Scenes = "meadow", preset: Preset = None, size: Size = "1280x720", *, json: Json = False, on: On = None
) -> None:
    """Measure frame times on larger and larger terrains, up to 10 km.

    With --on, each machine measures one scene at a time.
    """
    take = Take(scene, size_of(size), preset)
    from .many import bench_many
    from .scale import SURVEY

    bench_many(take, SURVEY, json=json, on=on)


@bench.command("all")
def all_(
    output: Output,
    scene: Scene = "meadow",
    preset: Preset = None,
    size: Annotated[
        str | None, typer.Option(metavar="WxH", help="Width and height in pixels; by default each benchmark's own.")
    ] = None,
    against: Annotated[
        str | None, typer.Option(metavar="FILE", help="The bench.json of an earlier run, to compare with.")
    ] = None,
    *,
    json: Json = False,
) -> None:
    """Run every benchmark, and write bench.json and a page with plots into a folder."""
    pixels = None if size is None else size_of(size)
    from .whole import bench_all

    bench_all(scene, output, preset=preset, size=pixels, against=against, json=json)
