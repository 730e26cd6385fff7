"""The commands of `tallgrass bench`: what each of them takes."""

from typing import Annotated

import typer

from ..options import Hold, Json, On, Output, Preset, Scene, Size, bundled, size_of
from ..studio.take import Take

Scenes = Annotated[
    str, typer.Argument(metavar="SCENE", help="A scene file, a bundled scene, or a folder.", autocompletion=bundled)
]

bench = typer.Typer(help="Measure: what frames take, how true they are, and whether they pop.", no_args_is_help=True)


@bench.command("frame")
def frame(
    scene: Scene = "meadow",
    preset: Preset = None,
    size: Size = "1280x720",
    *,
    json: Json = False,
    viewers: Annotated[int, typer.Option(min=1, max=16, help="Viewers in every frame, side by side.")] = 1,
) -> None:
    """Measure how long a frame takes, and what it is made of."""
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
    output: Annotated[str | None, typer.Option("-o", "--output", help="A folder for pictures with references.")] = None,
    on: On = None,
) -> None:
    """Measure how far a picture is from every blade in 3D, supersampled; of a folder, those of all its scenes."""
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
    parts: Annotated[bool, typer.Option("--parts", help="Also leave out each part of the transitions alone.")] = False,
    output: Annotated[str | None, typer.Option("-o", "--output", help="A folder for pictures of what shows.")] = None,
    hold: Hold = None,
    climb: Annotated[
        bool, typer.Option("--climb", help="Climb up to 60 m instead of walking, and then look straight down.")
    ] = False,
    on: On = None,
) -> None:
    """Measure whether a change of representation can be seen on a walk; of a folder, in all its scenes."""
    take = Take(scene, size_of(size), preset)
    from .many import bench_many
    from .pop import must_be_large, pop_survey

    must_be_large(take.size)
    bench_many(take, pop_survey(parts=parts, hold=hold, rising=climb), json=json, output=output, on=on)


@bench.command("walk")
def walk(scene: Scene = "meadow", preset: Preset = None, size: Size = "1280x720", *, json: Json = False) -> None:
    """Measure whether frames keep taking the same time on a walk."""
    take = Take(scene, size_of(size), preset)
    from .machine import tell
    from .walk import walk_measured

    tell(walk_measured(take), as_json=json)


@bench.command("scale")
def scale(
    scene: Scenes = "meadow", preset: Preset = None, size: Size = "1280x720", *, json: Json = False, on: On = None
) -> None:
    """Measure what a larger terrain costs, up to 10 km; by workers, on one scene at a time on each machine."""
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
        str | None, typer.Option(metavar="WxH", help="Of all pictures; else each benchmark has its own.")
    ] = None,
    against: Annotated[
        str | None, typer.Option(metavar="FILE", help="The bench.json of another version, to be shown beside.")
    ] = None,
    *,
    json: Json = False,
) -> None:
    """Run every benchmark, and write bench.json and a page with plots into a folder."""
    pixels = None if size is None else size_of(size)
    from .whole import bench_all

    bench_all(scene, output, preset=preset, size=pixels, against=against, json=json)
