"""Lines to be copied into a terminal."""

import re
import shlex
import sys
from collections.abc import Sequence

WINDOWS = ("win32",)
_SPECIAL = re.compile(r"[^\w.:\\/+@-]")


def command_line(words: Sequence[str], /) -> str:
    """Return the line that runs a command of these words: for `cmd.exe` on Windows, elsewhere for `sh`.

    `cmd.exe` knows no quotes but double ones; without them, `>=1` would make a file.
    """
    if sys.platform not in WINDOWS:
        return shlex.join(words)
    return " ".join(f'"{word}"' if _SPECIAL.search(word) or not word else word for word in words)
