# SPDX-License-Identifier: BSD-3-Clause
"""Names of the constants of a message, so that nobody keeps a copy of them."""


def names(message_type):
    """The names of a message's constants in the order of their values, which are 0, 1, 2, ...

    names(ExecutionProgress)[progress.state] is the name of a state.
    """
    values = {name: value for name, value in vars(message_type).items()
              if name.isupper() and isinstance(value, int)}
    if sorted(values.values()) != list(range(len(values))):
        raise ValueError(f"constants of {message_type.__name__} are {values}, must be 0, 1, 2, ...")
    return sorted(values, key=lambda name: values[name])
