"""Remembering what follows from things that are never written to."""

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

Thing = TypeVar("Thing")
Answer = TypeVar("Answer")


def by_identity(most: int) -> Callable[[Callable[[Thing], Answer]], Callable[[Thing], Answer]]:
    """Return a decorator that remembers a function's answers for the latest `most` things it was asked about.

    Things are told apart by what they are and not by what they hold: they need no hash, and nobody may write to them.
    """

    def decorated(function: Callable[[Thing], Answer]) -> Callable[[Thing], Answer]:
        known: dict[int, tuple[Thing, Answer]] = {}  # a thing is held, so that no other can have its identity

        @wraps(function)
        def asked(thing: Thing, /) -> Answer:
            found = known.get(id(thing))
            if found is None:
                if len(known) >= most:
                    del known[next(iter(known))]
                found = known[id(thing)] = thing, function(thing)
            return found[1]

        return asked

    return decorated


def while_it_lives(function: Callable[[Thing], Answer]) -> Callable[[Thing], Answer]:
    """Remember a function's answers for as long as the things that it was asked about are there."""
    known: WeakKeyDictionary[Thing, Answer] = WeakKeyDictionary()

    @wraps(function)
    def asked(thing: Thing, /) -> Answer:
        found = known.get(thing)
        if found is None:
            found = known[thing] = function(thing)
        return found

    return asked
