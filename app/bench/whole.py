"""`tallgrass bench all`: every benchmark of a scene, in one file, and on one page beside an earlier one."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from time import perf_counter

from ... import __version__
from ...engine.scene import read_scene
from ..figures.make import need_matplotlib
from ..studio.encode import make_folder, write_whole
from ..studio.errors import InputError
from ..studio.progress import course
from ..studio.take import Take
from .flip import evaluator
from .frame import frame_measured
from .machine import tell
from .picture import measured
from .pop import LIMITS, pop_measured
from .scale import scale_measured
from .sent import Told
from .walk import walk_measured

Size = tuple[int, int]

LARGE, SMALL = (1280, 720), (640, 360)
"""Size of pictures in the benchmarks [pixels]; the small one is that of `bench pop`."""

SHARES = {"frame": 60.0, "walk": 120.0, "scale": 60.0, "picture": 20.0, "pop": 70.0}
"""The benchmarks, and how long they take in terms of one another, about."""


def bench_all(
    scene: str, output: str, *, preset: str | None, size: Size | None, against: str | None, json: bool
) -> None:
    """Run every benchmark of a scene, and write `bench.json` and `bench.html` into a folder.

    Without `size` each has the size that it has alone. `against` is the `bench.json` of another time, to be shown
    beside. Before anything is drawn it raises InputError where that is none or the folder cannot be written,
    `SceneError` where the scene is wrong, MachineError where pictures cannot be compared or plots not be drawn.
    """
    need_matplotlib()
    evaluator()
    before = None if against is None else read_told(against)
    folder = Path(output)
    make_folder(folder)
    told = all_measured(scene, preset=preset, size=size)
    from .page import page

    write_whole(as_text(told), folder / "bench.json")
    write_whole(page(told, before), folder / "bench.html")
    if json:
        tell(told, as_json=True)
    else:
        print(f"{folder / 'bench.json'}\n{folder / 'bench.html'}")


def all_measured(scene: str, *, preset: str | None, size: Size | None) -> Told:
    """Return what every benchmark tells of a scene; `scale` is None where its terrain comes from a file."""
    large, small = Take(scene, size or LARGE, preset), Take(scene, size or SMALL, preset)
    noise = read_scene(scene).scene.terrain.heights is None
    work: dict[str, Callable[[], Mapping[str, object] | None]] = {
        "frame": lambda: frame_measured(large),
        "walk": lambda: walk_measured(large),
        "scale": lambda: scale_measured(large) if noise else None,
        "picture": lambda: measured(large),
        "pop": lambda: pop_measured(small),
    }
    found: Told = {}
    took: dict[str, float] = {}
    with course("every benchmark", SHARES) as way:
        for name, measure in work.items():
            with way.part(name):
                start = perf_counter()
                found[name] = measure()
                took[name] = round(perf_counter() - start, 1)
    head = {"version": __version__, "machine": found["frame"]["machine"], "scene": scene}
    return head | {"preset": found["frame"]["preset"], "took_s": took, "limits": LIMITS} | found


def as_text(told: Told, /) -> str:
    """Return a result as the text of its file."""
    return json.dumps(told, indent=1) + "\n"


def read_told(file: str, /) -> Told:
    """Return what `bench all` has written; raises InputError where a file is not of that kind."""
    try:
        told = json.loads(Path(file).read_text("utf-8"))
    except OSError as error:
        raise InputError(f"--against: {file}: {error.strerror}") from None
    except ValueError:
        told = None
    if not isinstance(told, dict) or not {"version", "machine", *SHARES} <= told.keys():
        raise InputError(f"--against: {file}: this is no bench.json of `tallgrass bench all`")
    return told
