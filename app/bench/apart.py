"""Work in a process of its own: with another environment, or with memory that nothing else has used."""

import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TypeVar

from ..studio.errors import MachineError

Result = TypeVar("Result")

LONGEST = 900.0
"""Timeout of a process [s]."""

SAME: Mapping[str, str] = MappingProxyType({})
"""No change of the environment."""


def apart(work: Callable[..., Result], /, *arguments: object, environment: Mapping[str, str] = SAME) -> Result:
    """Call a module's function in a new process, and return its result; raises MachineError where that fails.

    Variables of `environment` are added to this one's. It is not done by multiprocessing, as Dask's workers may not
    start processes that way.
    """
    command, given = [sys.executable, "-m", __name__], pickle.dumps((work, arguments))
    variables = os.environ | environment
    try:
        done = subprocess.run(  # noqa: S603 - it is our own module
            command, input=given, stdout=subprocess.PIPE, env=variables, timeout=LONGEST, check=True
        )
    except (OSError, subprocess.SubprocessError) as error:
        raise MachineError(f"a process of its own failed: {error}") from error
    result: Result = pickle.loads(done.stdout)  # noqa: S301 - our own module's
    return result


def main() -> None:
    """Do the work that comes by standard input; whatever is printed meanwhile goes to standard error."""
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    work, arguments = pickle.load(sys.stdin.buffer)  # noqa: S301 - our own module's
    with answer:
        pickle.dump(work(*arguments), answer)


if __name__ == "__main__":
    main()
