"""The schema from the command line."""

import json
import subprocess
from collections.abc import Callable

Tallgrass = Callable[..., subprocess.CompletedProcess[str]]


def test_d4_the_command_prints_the_schema_of_scene_files(tallgrass: Tallgrass) -> None:
    done = tallgrass("schema")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.isascii()
    schema = json.loads(done.stdout)
    assert {"blast", "breeze", "gust", "whirlwind"} <= set(
        schema["properties"]["wind"]["items"]["properties"]["kind"]["enum"]
    )
    assert "make it again" in schema["$comment"]
