"""Importing Dask, which only distributed work needs; keeping it quiet; and the versions that must agree."""

import importlib
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ... import __version__
from ..studio.errors import needed

SETTINGS = {
    "distributed.admin.large-graph-warning-threshold": "4GiB",  # maps are large, and sent once
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": None,  # trimmed, memory is asked for in every frame
}
"""Settings that differ from Dask's defaults."""

SILENT = logging.CRITICAL + 1
"""Level at which a log is silent."""


def need_distributed() -> Any:
    """Return Dask's `distributed`; raises MachineError where it is not installed."""
    return needed("distributed", "work is handed out by Dask's distributed", extra="farm")


def versions() -> str:
    """Return the versions on this machine of the packages that pictures depend on."""
    return f"tallgrass {__version__} with numpy {np.__version__}"


def cores() -> int:
    """Return the number of cores by Dask's count, which keeps to the limits of a container."""
    return int(importlib.import_module("dask.system").CPU_COUNT)


@contextmanager
def quiet() -> Iterator[None]:
    """Silence Dask's logs of workers that come and go; errors are raised anyway."""
    need_distributed()  # importing it sets the levels of its logs
    names = [name for name in logging.root.manager.loggerDict if name.partition(".")[0] == "distributed"]
    before = {name: logging.getLogger(name).level for name in names}
    for name in names:
        logging.getLogger(name).setLevel(SILENT)
    with importlib.import_module("dask").config.set(SETTINGS):
        try:
            yield
        finally:
            for name, level in before.items():
                logging.getLogger(name).setLevel(level)
