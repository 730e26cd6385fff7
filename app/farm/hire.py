"""Hiring: starting workers on this machine, or connecting to a scheduler's address."""

import asyncio
import os
import re
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from tempfile import TemporaryDirectory
from typing import Any

from ..studio.errors import InputError, MachineError
from ..studio.progress import busy
from . import worker
from .dask import SILENT, cores, need_distributed, quiet, versions
from .hands import Hands

ANSWER = 4.0
"""Timeout of a scheduler's answer [s]."""

_LOCAL = re.compile(r"local(?::([1-9][0-9]{0,2}))?")
_ADDRESS = re.compile(r"(?:[a-z]+://)?(?:[^\s:/]+|\[[0-9a-fA-F:]+\]):[0-9]{1,5}")


@contextmanager
def hired(on: str, /, *, most: int) -> Iterator[Hands]:
    """Yield the workers of a place, and let them go at the end.

    `on` is `local` for a worker per core of this machine, `local:4` for four workers, at most `most` of them; or the
    address of a Dask scheduler. Raises InputError where it is none of these, MachineError without Dask, and where no
    scheduler answers.
    """
    here = _LOCAL.fullmatch(on)
    if not here and (on.startswith("local:") or not _ADDRESS.fullmatch(on)):
        raise InputError(f"--on: '{on}' is neither local, local:4 nor a scheduler's address like tcp://host:8786")
    distributed = need_distributed()
    with quiet(), ExitStack() as stack:
        if here:
            count = min(int(here[1] or cores()), most)
            with busy(f"waking {count} workers"):
                client = stack.enter_context(_here(distributed, count))
        else:
            with busy(f"looking for {on}"):
                client = stack.enter_context(_connected(distributed, on))
        yield Hands(client, f"--on: {on}")


@contextmanager
def _here(distributed: Any, count: int) -> Iterator[Any]:
    with TemporaryDirectory(prefix="tallgrass-", ignore_cleanup_errors=True) as scratch:
        cluster = distributed.LocalCluster(
            n_workers=count, threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=SILENT,
            local_directory=scratch, env=shared_cores(count), preload=worker.__name__,
        )  # fmt: skip
        with cluster, distributed.Client(cluster) as client:
            yield client


def shared_cores(count: int, /) -> dict[str, str]:
    """Return the environment in which workers share the cores where Mesa draws in software; empty if set already."""
    return {} if "LP_NUM_THREADS" in os.environ else {"LP_NUM_THREADS": str(max(1, cores() // count))}


@contextmanager
def _connected(distributed: Any, address: str) -> Iterator[Any]:
    try:
        asyncio.run(_greet(distributed, address))
        client = distributed.Client(address, timeout=ANSWER)
    except (TypeError, ValueError) as error:  # an unknown protocol, or TLS without certificates
        raise MachineError(f"--on: {address}: {error}") from None
    except Exception as error:
        raise MachineError(f"--on: {address}: no Dask scheduler answers there") from error
    with client:
        if not client.nthreads():
            raise MachineError(f"--on: {address}: this scheduler has no workers; start some: dask worker {address}")
        _must_be_alike(client, address)
        yield client


def _must_be_alike(client: Any, address: str) -> None:
    """Raise MachineError where the scheduler or a worker has other versions than this machine."""
    for who, found in versions_at(client).items():
        if found != versions():
            has = found if isinstance(found, str) else f"not the tallgrass that this machine has ({found})"
            raise MachineError(f"--on: {address}: {who} has {has}; install {versions()} there, as here")


def versions_at(client: Any, /) -> dict[str, object]:
    """Return the versions of a scheduler and its workers by name, or the errors of asking for them."""
    by_worker = {f"the worker {worker}": found for worker, found in client.run(versions, on_error="return").items()}
    try:
        return {"the scheduler": client.run_on_scheduler(versions), **by_worker}
    except ImportError as error:
        return {"the scheduler": error}


async def _greet(distributed: Any, address: str) -> None:
    """Ask a scheduler for its identity, with the timeout `ANSWER` even where something else listens there."""
    settings = distributed.Security().get_connection_args("client")
    scheduler = distributed.rpc(address, timeout=ANSWER, connection_args=settings)
    try:
        await asyncio.wait_for(scheduler.identity(), ANSWER)
    finally:
        await scheduler.close_rpc()
