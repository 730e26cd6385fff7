"""Hiring: where the workers are, on this machine or at a scheduler's address."""

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
"""How long a scheduler may take to answer [s]."""

_LOCAL = re.compile(r"local(?::([1-9][0-9]{0,2}))?")
_ADDRESS = re.compile(r"(?:[a-z]+://)?(?:[^\s:/]+|\[[0-9a-fA-F:]+\]):[0-9]{1,5}")


@contextmanager
def hired(on: str, /, *, most: int) -> Iterator[Hands]:
    """Yield the workers of a place, and let them go at the end.

    `on` is `local`, a worker for each core of this machine; `local:4`, so many; but no more than `most`; or the address
    of a Dask scheduler. Raises InputError where it is none of these, MachineError without Dask, and where nobody
    answers.
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
                client = stack.enter_context(_at(distributed, on))
        yield Hands(client, f"--on: {on}")


@contextmanager
def _here(distributed: Any, count: int) -> Iterator[Any]:
    with TemporaryDirectory(prefix="tallgrass-", ignore_cleanup_errors=True) as scratch:
        cluster = distributed.LocalCluster(
            n_workers=count, threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=SILENT,
            local_directory=scratch, env=shared_out(count), preload=worker.__name__,
        )  # fmt: skip
        with cluster, distributed.Client(cluster) as client:
            yield client


def shared_out(count: int, /) -> dict[str, str]:
    """Return what lets so many workers share the cores where Mesa draws in software, unless the user has said it."""
    return {} if "LP_NUM_THREADS" in os.environ else {"LP_NUM_THREADS": str(max(1, cores() // count))}


@contextmanager
def _at(distributed: Any, address: str) -> Iterator[Any]:
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
    """Ask scheduler and workers what they have; raises MachineError where that is not what this machine has."""
    for who, told in told_of(client).items():
        if told != versions():
            has = told if isinstance(told, str) else f"not the tallgrass that this machine has ({told})"
            raise MachineError(f"--on: {address}: {who} has {has}; install {versions()} there, as here")


def told_of(client: Any, /) -> dict[str, object]:
    """Return the versions of everybody at a scheduler, or what came of asking for them."""
    told = {f"the worker {worker}": had for worker, had in client.run(versions, on_error="return").items()}
    try:
        return {"the scheduler": client.run_on_scheduler(versions), **told}
    except ImportError as error:
        return {"the scheduler": error}


async def _greet(distributed: Any, address: str) -> None:
    """Ask a scheduler who it is, and wait no longer than `ANSWER`, whatever it is that listens there."""
    settings = distributed.Security().get_connection_args("client")
    scheduler = distributed.rpc(address, timeout=ANSWER, connection_args=settings)
    try:
        await asyncio.wait_for(scheduler.identity(), ANSWER)
    finally:
        await scheduler.close_rpc()
