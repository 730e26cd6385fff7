"""A pyglet game that has a prairie in it: what `test_pyglet.py` runs, with a display and without one.

It prints one line of JSON: for each check its faults, an empty text where there are none. The picture of a check
is compared with one that the same program draws without its prairie.
"""

import json
import sys

from pyglet import gl

from . import drawing, windows
from .game import Game
from .states import tidy


def main() -> None:
    """Run all checks and print their faults."""
    found = {"no_window": windows.check_no_window()}
    game = Game()
    for name, run in [*vars(drawing).items(), *vars(windows).items()]:
        if name.startswith("check_") and run is not windows.check_no_window:
            tidy()
            found[name.removeprefix("check_")] = run(game)
    sys.stdout.write(json.dumps({"version": "{}.{}".format(*gl.gl_info.get_version()), **found}))


if __name__ == "__main__":
    main()
