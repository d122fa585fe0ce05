"""How the hot loops are compiled: by numba, once, and kept on disk for the next process.

Numba keeps a compiled function for as long as its own file is unchanged, but not the files of the functions that it
calls: after an upgrade, old and new loops would mix. Here a function is kept for as long as every file that holds
compiled functions, or the arrays that they take, is unchanged.
"""

import hashlib
from pathlib import Path

from numba import njit

from .putting_off import put_off

# No reference counting (`_nrt`): the loops allocate nothing, and counting the arrays of a call costs more than the
# call. No "nnan", "ninf" of fast-math: a state that is not finite must be seen.
OPTIONS = {
    "cache": True,
    "nogil": True,
    "error_model": "numpy",
    "fastmath": {"contract", "reassoc", "nsz", "arcp"},
    "_nrt": False,
}


# of files that the loops are compiled from
SIGNS = b"from .compiled import", b"from numba", b"from .lanes import", b"from .packed import Form"


def _stamp() -> str:
    content = hashlib.sha256(Path(__file__).read_bytes())
    for path in sorted(Path(__file__).parent.glob("*.py")):
        source = path.read_bytes()
        if any(sign in source for sign in SIGNS):
            content.update(path.name.encode() + source)
    return content.hexdigest()


STAMP = _stamp()


def compiled(function):
    """Decorator: compile `function` on its first call, or load it as compiled by an earlier process."""
    return _kept(njit(**OPTIONS)(function))


def inlined(function):
    """Decorator: as `compiled`, and built into whoever calls it; for the parts of one evaluation. `TypeError` where
    Python calls it: the way in from there takes as long to compile as the function."""

    def refuse(*arguments, **named):
        raise TypeError(f"{function.__name__} is for compiled loops to call")

    dispatcher = njit(**OPTIONS, forceinline=True, no_cpython_wrapper=True, no_cfunc_wrapper=True)(function)
    dispatcher._insert = lambda *entry, **named: None  # there is none
    dispatcher._compile_for_args = refuse
    return _kept(dispatcher)


def shared(function):
    """Decorator: as `inlined`, and for Python to call as well."""
    return _kept(njit(**OPTIONS, forceinline=True)(function))


def spliced(function):
    """Decorator: for a piece of a loop that is written apart to be read; it becomes part of its caller's source, which
    saves the time to compile it apart."""
    return njit(**{**OPTIONS, "cache": False}, inline="always")(function)


def _kept(dispatcher):
    kept = dispatcher._cache._cache_file
    kept._source_stamp = STAMP
    kept._version = (
        f"{kept._version} {STAMP}"  # what another version has kept is not even opened: its types may be gone
    )
    compile_it = dispatcher.compile

    def compile_whole(signature):
        with put_off():
            return compile_it(signature)

    dispatcher.compile = compile_whole
    return dispatcher
