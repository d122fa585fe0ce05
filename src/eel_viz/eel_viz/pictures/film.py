# SPDX-License-Identifier: Apache-2.0
"""Makes a film from pictures: with ffmpeg if installed, or else as an animated GIF or WebP."""

import itertools
import os
import pathlib
import shutil
import subprocess

from eel_common.files.output_file import replacing
from eel_common.wording import shown
from PIL import Image

ANIMATIONS = (".gif", ".webp")
PICTURE_NAME = "frame_%05d.png"
QUALITY = 60  # of a .webp
UNITS = {".gif": 10, ".webp": 1}  # ms: a picture of an animation lasts a multiple of this
FILMS = (".mp4", ".webm", ".mkv", ".mov", *ANIMATIONS)


def ffmpeg() -> str | None:
    """The path of ffmpeg; None if it is not installed."""
    return shutil.which("ffmpeg")


def check_quality(quality: int) -> None:
    """`ValueError` if `quality` is not between 1 and 100."""
    if not 1 <= quality <= 100:
        raise ValueError(f"quality must be 1 to 100, got {quality}")


def check_film(path: pathlib.Path) -> None:
    """`ValueError` for a suffix that is not a film's, or that needs ffmpeg if that is missing."""
    if path.suffix not in FILMS:
        raise ValueError(f"film must end in one of {', '.join(FILMS)}, got {shown(str(path))}")
    if path.suffix not in ANIMATIONS and ffmpeg() is None:
        raise ValueError(f"ffmpeg is not installed, which {path.suffix} needs; {' and '.join(ANIMATIONS)} do without")


def film(
    folder: str | os.PathLike[str], count: int, output: str | os.PathLike[str], *, fps: float, quality: int = QUALITY
) -> None:
    """Write the film `output` from the first `count` pictures in `folder`, of equal size, with `fps` per second.

    Their names follow `PICTURE_NAME`. quality: of a .webp, 1 (smallest file) to 100.
    `ValueError` as in `check_quality` and `check_film`; `OSError` if writing fails.
    """
    path, program = pathlib.Path(output), ffmpeg() or ""
    check_quality(quality)
    check_film(path)
    with replacing(path) as draft:
        if path.suffix in ANIMATIONS:
            _animate([pathlib.Path(folder) / (PICTURE_NAME % k) for k in range(count)], draft, fps, quality)
        else:
            _encode(program, pathlib.Path(folder) / PICTURE_NAME, count, draft, fps)


def durations(count: int, fps: float, unit: int) -> list[int]:
    """The duration of each of `count` pictures [ms], in multiples of `unit` [ms]: `fps` per second in total."""
    ends = [round(1000.0 * k / fps / unit) for k in range(count + 1)]
    return [unit * max(1, end - begin) for begin, end in itertools.pairwise(ends)]


def _encode(program: str, pictures: pathlib.Path, count: int, path: pathlib.Path, fps: float) -> None:
    even = "pad=ceil(iw/2)*2:ceil(ih/2)*2"  # most codecs need even sizes
    command = [program, "-y", "-v", "error", "-framerate", f"{fps:g}", "-i", str(pictures)]
    command += ["-frames:v", str(count), "-vf", even, "-pix_fmt", "yuv420p", str(path)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode:
        raise OSError(f"ffmpeg said: {' '.join(done.stderr.split())[-300:]}")


def _animate(pictures: list[pathlib.Path], path: pathlib.Path, fps: float, quality: int) -> None:
    def picture(name: pathlib.Path) -> Image.Image:
        with Image.open(name) as image:
            return image.convert("RGB")

    first, *others = pictures
    picture(first).save(
        path,
        save_all=True,
        append_images=(picture(name) for name in others),
        duration=durations(len(pictures), fps, UNITS[path.suffix]),
        loop=0,
        quality=quality,
    )
