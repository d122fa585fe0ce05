"""Why a node cannot start, in one line, with the command that repairs a damaged build."""

from rclpy.exceptions import NameValidationException, ParameterException
from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport

from eel_gaits.command_line import complain

CANNOT_START = (
    ValueError,
    RuntimeError,
    OSError,
    ParameterException,
    NameValidationException,
    UnsupportedTypeSupport,
)
REPAIR = "a library of the messages is damaged or missing, `make clean build` makes all anew"


def tell_no_start(program: str, error: Exception) -> None:
    """Say why `program` cannot start."""
    damaged = isinstance(error, UnsupportedTypeSupport) or "type support" in str(error).lower()
    complain(program, f"{REPAIR}: {error}" if damaged else error)
