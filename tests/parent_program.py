"""Import what all programs import, then fork for each line of JSON on standard input to run the program that it names.

The fixture `python` of conftest.py writes the lines.
"""

import json
import os
import runpy
import sys
from pathlib import Path

import tallgrass.systems.holding
import tallgrass.systems.prairie
import tallgrass.testing

tallgrass.systems.holding.AHEAD = False
for line in sys.stdin:
    told = json.loads(line)
    child = os.fork()
    if not child:
        break
    sys.stdout.write(f"{os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])}\n")
    sys.stdout.flush()
else:
    sys.exit()
os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
os.dup2(os.open(told["output"], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), 1)
os.dup2(1, 2)
os.chdir(told["folder"])
os.environ.update(told["place"])
sys.argv, sys.path[0] = [told["program"], *told["arguments"]], str(Path(told["program"]).resolve().parent)
if told["before"]:
    exec(told["before"])  # noqa: S102 - a test says what
runpy.run_path(told["program"], run_name="__main__")
