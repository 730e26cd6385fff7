"""The cost of frames on the CPU alone, measured in a child process whose driver draws nothing."""

import json
import os
import subprocess
import sys
from typing import Any

from ..studio.take import Take, words_of

NOOP = {"GALLIUM_NOOP": "1"}
"""Environment by which Mesa accepts every command and draws nothing; other drivers ignore it."""

LONGEST = 900.0
"""Timeout of the child process [s]."""


def on_processor(take: Take, /, *, walk: bool = False) -> dict[str, Any] | None:
    """Return the figures of the module `noop` for a take, or None where the driver always draws or the child fails."""
    command = [sys.executable, "-m", f"{__package__}.noop", *["--walk"] * walk, *words_of(take)]
    try:
        done = subprocess.run(  # noqa: S603 - it is our own module
            command,
            env=os.environ | NOOP,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            text=True,
            timeout=LONGEST,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    lines = done.stdout.splitlines()
    result: dict[str, Any] | None = json.loads(lines[-1]) if done.returncode == 0 and lines else None
    return result
