"""The compiled module, whichever level of the processor it is for."""

def build_info() -> dict[str, str]:
    """How this module was compiled: level, compiler, flags, sanitizers, pybind11."""
