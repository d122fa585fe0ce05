# SPDX-License-Identifier: Apache-2.0
"""`eel render`: draw a recording to pictures or a film, without a display.

eel render RUN.rrd -o picture.png                # --at 7.0: at another time
eel render RUN.rrd -o frames/ --fps 30           # frames/frame_00000.png ..., and frames/film.mp4 with ffmpeg
eel render RUN.rrd -o swim.webp --fps 15 --size 960x540
eel render RUN.rrd -o swim.webp --fps 15 --size 800x450 --bare    # the swimmer alone
eel render RUN.rrd -o pair.webp --fps 15 --size 640x400 --bare --beside OTHER.rrd
"""

import argparse
import contextlib
import math
import os
import pathlib
import tempfile
from collections.abc import Callable, Sequence

from eel_common.command.command import command
from eel_common.command.command_line import Parser, print_to_stderr
from eel_common.command.progress import Progress
from eel_common.files.output_file import NotWritten, check_output, replacing, written_as
from eel_common.wording import shown

from eel_viz.pictures.drawing import SIZE, Drawing, SideBySide, check_recording, drawn_beside
from eel_viz.pictures.film import FILMS, PICTURE_NAME, QUALITY, check_film, check_quality, ffmpeg, film
from eel_viz.viewer import CannotRender

NAME = "eel render"
FILM = "film.mp4"
MANY = 100_000  # pictures
DEFAULT_SHARE = 0.7  # of a recording's duration: time of a single picture, when the swimmer moves


def times(
    drawing: Drawing | SideBySide, *, fps: float, start: float | None, end: float | None, speed: float
) -> list[float]:
    """Simulation times [s] of the pictures of a film with `fps` per second, at `speed` times real time."""
    _check_positive(fps=fps, speed=speed)
    start = drawing.start if start is None else start
    end = drawing.end if end is None else end
    if not start <= end:
        raise ValueError(f"end must not come before start, got {start:g} to {end:g} s")
    count = math.floor((end - start) * fps / speed + 1e-6) + 1
    if count > MANY:
        raise ValueError(f"fps {fps:g} from {start:g} to {end:g} s makes {count} pictures, more than {MANY}")
    return [start + k * speed / fps for k in range(count)]


def frames(
    drawing: Drawing | SideBySide,
    folder: pathlib.Path,
    at: Sequence[float],
    progress: Callable[[int, int], object] = lambda done, count: None,
) -> list[pathlib.Path]:
    """Write pictures at the times `at` [s] to frame_00000.png and so on in `folder`. Returns their paths.

    `NotWritten` if another process writes there too.
    """
    written = []
    for k, moment in enumerate(at):
        png = drawing.png(min(moment, drawing.end))
        written.append(folder / (PICTURE_NAME % k))
        with replacing(written[-1]) as draft:
            draft.write_bytes(png)
        if written_as(written[-1]) != written[-1]:  # a film would use the other's picture
            raise NotWritten(f"another process writes pictures to {shown(str(folder))} too")
        progress(k + 1, len(at))
    return written


def _add_options(parser: Parser) -> None:
    parser.add_argument("recording", help="file .rrd; one that was cut short is drawn as far as it goes")
    parser.add_argument("picture", nargs="?", help="as -o")
    parser.add_argument(
        "-o",
        "--out",
        metavar="OUT",
        help="with --at a PNG; with --fps a folder, made in one that exists, for frame_00000.png ... and, where "
        f"ffmpeg is installed, {FILM}; or a film alone: {', '.join(FILMS)} (the last two do without ffmpeg)",
    )
    which = parser.add_mutually_exclusive_group()
    which.add_argument(
        "--at",
        type=float,
        metavar="SECONDS",
        help=f"simulation time of one picture (default: after {DEFAULT_SHARE:.0%}% of the recording)",
    )
    which.add_argument("--fps", type=float, metavar="N", help="pictures a second of a film")
    parser.add_argument("--start", type=float, metavar="SECONDS", help="of the film (default: the recording's)")
    parser.add_argument("--end", type=float, metavar="SECONDS", help="of the film (default: the recording's)")
    parser.add_argument(
        "--speed", type=float, default=1.0, metavar="X", help="simulated seconds in a second of the film (default 1)"
    )
    parser.add_argument(
        "--quality", type=int, default=QUALITY, metavar="N", help="of a .webp, 1 to 100 (default %(default)s)"
    )
    parser.add_argument("--size", default=f"{SIZE[0]}x{SIZE[1]}", metavar="WxH", help="in pixels (default %(default)s)")
    parser.add_argument(
        "--blueprint", default="", metavar="NAME", help="arrangement: overview, torques ... (default: the first)"
    )
    parser.add_argument(
        "--bare",
        action="store_true",
        help="the first view of the arrangement alone, without the viewer's frame (default arrangement: swimmer); "
        "a size 1.4 times as wide as high, or more, shows the whole swimmer and the legend",
    )
    parser.add_argument(
        "--beside", metavar="OTHER", help="another recording, drawn to the right at the same times and in the same size"
    )


@command(
    NAME,
    "Draw a Rerun recording to a PNG, to many, or to a film, without a display.",
    epilog="Needs a Vulkan driver; Mesa's software driver will do (apt-get install --no-install-recommends "
    "mesa-vulkan-drivers). Exit status: 0; 1 where the output cannot be written to its end; 2 for what cannot be; "
    "3 where the viewer cannot draw; with one line that says why.",
    add_options=_add_options,
    interrupted=" ",
)
def main(chosen: argparse.Namespace) -> None:
    output = chosen.out or chosen.picture
    check_recording(pathlib.Path(chosen.recording))
    if output is None:
        raise ValueError("where to write is missing: -o PICTURE.png, or -o FOLDER with --fps")
    try:
        width, height = (int(number) for number in chosen.size.split("x"))
    except ValueError:
        raise ValueError(f"--size must look like 1920x1080, got {shown(chosen.size)}") from None
    try:
        _draw(chosen, pathlib.Path(output), (width, height))
    except (CannotRender, ConnectionError) as reason:
        raise CannotRender(f"no picture: {reason}") from reason


def _draw(chosen: argparse.Namespace, output: pathlib.Path, size: tuple[int, int]) -> None:
    many = chosen.fps is not None
    alone = many and output.suffix in FILMS
    if many:
        _check_positive(fps=chosen.fps, speed=chosen.speed)
        check_quality(chosen.quality)
        if alone:
            check_film(output)
    elif output.suffix != ".png":
        raise ValueError(f"a picture must end in .png, got {shown(str(output))}; --fps N makes many in a folder")
    _check_writable(output, folder=many and not alone)
    with contextlib.ExitStack() as stack:
        drawing = stack.enter_context(
            drawn_beside(chosen.recording, chosen.beside, size=size, blueprint=chosen.blueprint, bare=chosen.bare)
        )
        if not many:
            late = drawing.start + DEFAULT_SHARE * (drawing.end - drawing.start)
            png = drawing.png(late if chosen.at is None else chosen.at)
            with replacing(output) as draft:
                draft.write_bytes(png)
            return
        at = times(drawing, fps=chosen.fps, start=chosen.start, end=chosen.end, speed=chosen.speed)
        folder = output
        if alone:
            folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        else:
            folder.mkdir(exist_ok=True)
        if any(folder.glob("frame_*.png")):
            print_to_stderr(NAME, f"{folder} has pictures already, those of the same number are replaced")
        written = frames(drawing, folder, at, Progress(NAME, "pictures"))
        name = output if alone else folder / FILM
        print(f"{len(written)} pictures" + ("" if alone else f" in {folder}"))
        if alone or ffmpeg() is not None:
            film(folder, len(written), name, fps=chosen.fps, quality=chosen.quality)
            print(f"film {written_as(name)}, {len(written) / chosen.fps:.3g} s")
        else:
            print(f"no film, for ffmpeg is not installed: ffmpeg -framerate {chosen.fps:g} -i "
                  f"{folder}/frame_%05d.png -pix_fmt yuv420p {name}")  # fmt: skip


def _check_positive(**values: float) -> None:
    for name, value in values.items():
        if not 0.0 < value < math.inf:
            raise ValueError(f"{name} must be > 0, got {value:g}")


def _check_writable(output: pathlib.Path, *, folder: bool) -> None:
    if not folder:
        check_output("output", output)
        return
    where = output if output.exists() else output.parent
    if not where.is_dir() or not os.access(where, os.W_OK):
        raise ValueError(
            f"output {shown(str(output))} cannot be written: {shown(str(where))} is no folder that can be written to"
        )
