"""What the tests of pages share: programs run as readers run them, without importing everything anew for each."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

Python = Callable[..., str]

PARENT = """
import json, os, runpy, sys

import tallgrass.systems.prairie, tallgrass.testing

for line in sys.stdin:
    told = json.loads(line)
    child = os.fork()
    if not child:
        break
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
else:
    sys.exit()
os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
os.dup2(os.open(told["output"], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), 1)
os.dup2(1, 2)
os.chdir(told["folder"])
os.environ.update(told["place"])
sys.argv, sys.path[0] = [told["program"]], told["folder"]
if told["before"]:
    exec(told["before"])
runpy.run_path(told["program"], run_name="__main__")
"""
"""Has imported all that programs import, and becomes one each time that it is told of one."""


@pytest.fixture(scope="session")
def python(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Python]:
    """Run a program in a folder and a process of its own, and return what it prints: `python(folder, name)`.

    `display` is where its windows open; `before` is what is run first.
    """
    output = tmp_path_factory.mktemp("python") / "output"
    command = [sys.executable, "-W", "error", "-W", "ignore:This process:DeprecationWarning", "-c", PARENT]
    place = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    with subprocess.Popen(command, env=place, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdin is not None
        assert parent.stdout is not None

        def run(folder: Path, program: str, *, display: str = "", before: str = "") -> str:
            given = {"DISPLAY": display} if display else {}
            told = {"folder": str(folder), "program": program, "place": given, "before": before, "output": str(output)}
            print(json.dumps(told), file=parent.stdin, flush=True)
            status, said = parent.stdout.readline(), output.read_text("utf-8")  # type: ignore[union-attr]
            assert status == "0\n", f"{program}\n{said}"
            return said

        yield run
        parent.stdin.close()
