"""Memoising functions of things that never change."""

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

Thing = TypeVar("Thing")
Answer = TypeVar("Answer")


def by_identity(most: int) -> Callable[[Callable[[Thing], Answer]], Callable[[Thing], Answer]]:
    """Return a decorator that caches a function's results for the `most` latest arguments, compared by identity.

    Arguments need no hash, but must never be written to.
    """

    def decorated(function: Callable[[Thing], Answer]) -> Callable[[Thing], Answer]:
        known: dict[int, tuple[Thing, Answer]] = {}  # holds the argument, so that no other object gets its identity

        @wraps(function)
        def cached(thing: Thing, /) -> Answer:
            found = known.get(id(thing))
            if found is None:
                if len(known) >= most:
                    del known[next(iter(known))]
                found = known[id(thing)] = thing, function(thing)
            return found[1]

        return cached

    return decorated


def while_it_lives(function: Callable[[Thing], Answer]) -> Callable[[Thing], Answer]:
    """Cache a function's results for as long as its arguments live."""
    known: WeakKeyDictionary[Thing, Answer] = WeakKeyDictionary()

    @wraps(function)
    def cached(thing: Thing, /) -> Answer:
        found = known.get(thing)
        if found is None:
            found = known[thing] = function(thing)
        return found

    return cached
