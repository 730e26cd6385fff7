"""What goes wrong at the doors."""


class InputError(Exception):
    """What a person asked for cannot be done as asked: its text is one line per problem, each with its place."""


class MachineError(Exception):
    """The asked is right, but this machine cannot do it: its text is one sentence that says what would help."""
