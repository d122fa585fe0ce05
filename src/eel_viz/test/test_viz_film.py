# SPDX-License-Identifier: Apache-2.0
"""`eel render` as a command: one picture, many, and a film, by one viewer; what cannot be is said in one line."""

import contextlib
import io
import stat

import numpy as np
import pytest
from eel_viz.pictures.drawing import SideBySide, drawn
from eel_viz.pictures.film import film
from eel_viz.pictures.render import main, times
from made_up_recording import record
from PIL import Image


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    path = tmp_path_factory.mktemp("recording") / "made_up.rrd"
    record(path, 1.0, 50.0)
    return path


@pytest.fixture
def fake_ffmpeg(tmp_path, monkeypatch):
    """An ffmpeg that writes down what it is asked for, alone on the PATH."""
    program = tmp_path / "bin" / "ffmpeg"
    program.parent.mkdir()
    program.write_text('#!/bin/sh\nfor last; do :; done\necho "$@" > "$last"\n')
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", f"{program.parent}:/usr/bin:/bin")


def pixels(png: bytes) -> np.ndarray:
    with Image.open(io.BytesIO(png)) as image:
        return np.asarray(image.convert("RGB")).astype(int)


def refusal(capsys, *arguments) -> str:
    status = main([str(word) for word in arguments])
    said = capsys.readouterr().err
    assert status == 2, said
    assert len(said.splitlines()) == 1, said
    return said


def test_one_viewer_draws_many_pictures_and_each_is_right(can_draw, recording, tmp_path, capsys, fake_ffmpeg):
    folder = tmp_path / "frames"
    words = ["--fps", "10", "--start", "0.6", "--end", "0.8", "--size", "640x361", "--blueprint", "torques"]
    assert main([str(recording), "-o", str(folder), *words]) == 0
    assert sorted(path.name for path in folder.iterdir()) == [
        "film.mp4", "frame_00000.png", "frame_00001.png", "frame_00002.png"
    ]  # fmt: skip
    asked = (folder / "film.mp4").read_text()
    assert f"-framerate 10 -i {folder}/frame_%05d.png -frames:v 3" in asked
    assert "3 pictures in" in capsys.readouterr().out
    pictures = [(folder / f"frame_0000{k}.png").read_bytes() for k in range(3)]
    assert len(set(pictures)) == 3
    with Image.open(folder / "frame_00000.png") as image:
        assert image.size == (640, 361)
    with drawn(recording, size=(640, 361), blueprint="torques") as drawing:
        assert (drawing.start, drawing.end) == (0.0, 1.0)
        first = drawing.png(0.8)  # taken when all has come to rest; between two viewers the edges of lines may differ
        assert (np.abs(pixels(first) - pixels(pictures[2])) > 2).mean() < 2e-3
        assert np.abs(pixels(first) - pixels(pictures[1])).max() > 50
        drawing.arrange("motion")
        assert drawing.png(0.8) != pictures[2]
        for wrong in (1.5, -0.1, float("nan")):
            with pytest.raises(ValueError, match="time must lie in the recording, 0 to 1 s"):
                drawing.png(wrong)
        with pytest.raises(ValueError, match=r"blueprint must be one of overview, torques, motion.*, got 'mine'"):
            drawing.arrange("mine")


@pytest.mark.fault(
    "names", "`eel render` of a recording that was cut short", "repaired in a copy, drawn as far as it goes"
)
def test_a_recording_that_was_cut_short_is_drawn(can_draw, tmp_path):
    record(tmp_path / "long.rrd", 3.0, 50.0)
    whole = (tmp_path / "long.rrd").read_bytes()
    (tmp_path / "cut.rrd").write_bytes(whole[: len(whole) * 3 // 4])
    with drawn(tmp_path / "cut.rrd", size=(320, 200)) as drawing:
        assert drawing.start == 0.0
        assert 0.5 < drawing.end <= 3.0
        assert drawing.png(0.5)


def test_films_by_ffmpeg_or_without(tmp_path, monkeypatch, fake_ffmpeg):
    for k in range(3):
        Image.new("RGB", (32, 16), (80 * k, 0, 0)).save(tmp_path / f"frame_0000{k}.png")
    film(tmp_path, 3, tmp_path / "film.webm", fps=12.5)
    assert "-framerate 12.5" in (tmp_path / "film.webm").read_text()
    (tmp_path / "bin" / "ffmpeg").write_text("#!/bin/sh\necho no such codec >&2\nexit 1\n")
    with pytest.raises(OSError, match=r"film\.mp4' cannot be written: ffmpeg said: no such codec"):
        film(tmp_path, 3, tmp_path / "film.mp4", fps=10)
    monkeypatch.setenv("PATH", str(tmp_path / "nothing"))
    with pytest.raises(ValueError, match=r"ffmpeg is not installed, which .mp4 needs; .gif and .webp do without"):
        film(tmp_path, 3, tmp_path / "film.mp4", fps=10)
    for suffix in ("gif", "webp"):
        film(tmp_path, 3, tmp_path / f"film.{suffix}", fps=10)
        with Image.open(tmp_path / f"film.{suffix}") as image:
            assert (image.n_frames, image.size) == (3, (32, 16))
            image.seek(2)
            assert image.convert("RGB").getpixel((5, 5))[0] == pytest.approx(160, abs=8)  # lossy
    with pytest.raises(ValueError, match=r"film must end in one of .mp4"):
        film(tmp_path, 3, tmp_path / "film.txt", fps=10)


@pytest.mark.fault(
    "ending",
    "the disk is full while `eel render`, `eel figures` or another study draw",
    "one line with the reason, status 1; an older picture or film stays as it was",
)
def test_a_film_that_does_not_fit_leaves_the_older_one(tmp_path, small_disk):
    noise = np.random.default_rng(1)
    for k in range(2):
        Image.fromarray(noise.integers(0, 256, (200, 200, 3), dtype=np.uint8)).save(tmp_path / f"frame_0000{k}.png")
    older = b"GIF89a of yesterday"
    (small_disk / "film.gif").write_bytes(older)
    (small_disk / "other").write_bytes(bytes(2**20 - 6 * 4096))
    with pytest.raises(OSError, match=r"film\.gif' cannot be written: No space left on device"):
        film(tmp_path, 2, small_disk / "film.gif", fps=10)
    assert sorted(path.name for path in small_disk.iterdir()) == ["film.gif", "other"]
    assert (small_disk / "film.gif").read_bytes() == older


def test_a_link_is_not_replaced_by_a_picture(recording, tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "a.png").symlink_to(tmp_path / "notes.txt")
    assert "a.png' cannot be written: it is a symbolic link" in refusal(capsys, recording, "-o", tmp_path / "a.png")
    assert (tmp_path / "notes.txt").read_text() == "mine"


class TenSeconds:
    start, end = 0.0, 10.0


def filled(colour: str, start: float, end: float):
    """A drawing of one colour."""

    class Filled:
        def __init__(self):
            self.start, self.end = start, end

        def png(self, at):
            told = io.BytesIO()
            Image.new("RGB", (30, 20), colour).save(told, format="PNG")
            return told.getvalue()

    return Filled()


def test_two_recordings_are_drawn_side_by_side_where_both_have_times():
    pair = SideBySide(filled("red", 0.0, 3.0), filled("blue", 1.0, 9.0))
    assert (pair.start, pair.end) == (1.0, 3.0)
    picture = pixels(pair.png(2.0))
    assert picture.shape == (20, 60, 3)
    assert (picture[:, :30] == (255, 0, 0)).all() and (picture[:, 30:] == (0, 0, 255)).all()
    with pytest.raises(ValueError, match="times in common, got 0 to 1 s and 2 to 3 s"):
        SideBySide(filled("red", 0.0, 1.0), filled("blue", 2.0, 3.0))


@pytest.mark.parametrize(("suffix", "unit"), [("gif", 10), ("webp", 1)])
def test_an_animation_lasts_as_long_as_it_should(tmp_path, suffix, unit):
    """At 30 pictures a second none lasts a whole number of the format's units."""
    for k in range(12):
        Image.new("RGB", (8, 8), (20 * k, 0, 0)).save(tmp_path / f"frame_{k:05d}.png")
    film(tmp_path, 12, tmp_path / f"film.{suffix}", fps=30.0)
    total = 0
    with Image.open(tmp_path / f"film.{suffix}") as image:
        for k in range(image.n_frames):
            image.seek(k)
            image.load()
            total += image.info["duration"]
    assert total == pytest.approx(400, abs=unit)


def test_the_times_of_a_film():
    assert times(TenSeconds, fps=30, start=None, end=None, speed=1.0)[-1] == pytest.approx(10.0)
    assert len(times(TenSeconds, fps=30, start=None, end=None, speed=1.0)) == 301
    assert times(TenSeconds, fps=2, start=1.0, end=3.0, speed=0.5) == pytest.approx([1 + k / 4 for k in range(9)])
    for name, value in (("fps", 0.0), ("fps", float("inf")), ("speed", -1.0)):
        with pytest.raises(ValueError, match=f"{name} must be > 0"):
            times(TenSeconds, **{"fps": 30, "speed": 1.0, "start": None, "end": None, name: value})
    with pytest.raises(ValueError, match="end must not come before start, got 5 to 2 s"):
        times(TenSeconds, fps=30, start=5.0, end=2.0, speed=1.0)
    with pytest.raises(ValueError, match="makes 10000001 pictures"):
        times(TenSeconds, fps=1e6, start=None, end=None, speed=1.0)


@pytest.mark.fault("names", "`eel render` where no driver draws", "one line that names the package, status 3")
def test_where_no_driver_draws_one_line_names_the_package(recording, tmp_path, monkeypatch, capsys):
    for name in ("VK_DRIVER_FILES", "VK_ICD_FILENAMES"):
        monkeypatch.setenv(name, str(tmp_path / "no_driver.json"))
    monkeypatch.setenv("WGPU_BACKEND", "vulkan")  # OpenGL might draw
    assert main([str(recording), "-o", str(tmp_path / "picture.png")]) == 3
    (line,) = capsys.readouterr().err.splitlines()
    assert "apt-get install" in line and "mesa-vulkan-drivers" in line


def test_without_a_time_the_picture_is_of_seven_tenths_of_the_recording(tmp_path, monkeypatch):
    class Drawing:
        start, end = 2.0, 12.0

        def png(self, at):
            return b"\x89PNG at %g s" % at

    monkeypatch.setattr("eel_viz.pictures.render.drawn_beside", lambda *_, **__: contextlib.nullcontext(Drawing()))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run.rrd").touch()
    assert main(["run.rrd", "-o", str(tmp_path / "picture.png")]) == 0
    assert (tmp_path / "picture.png").read_bytes() == b"\x89PNG at 9 s"
    assert main(["run.rrd", "-o", str(tmp_path / "picture.png"), "--at", "2"]) == 0
    assert (tmp_path / "picture.png").read_bytes() == b"\x89PNG at 2 s"


@pytest.mark.fault(
    "names",
    "`eel render` of what is no recording, to where nothing can be written, in a size that cannot be",
    "one line, status 2",
)
def test_what_cannot_be_is_said_in_one_line(recording, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", "/nothing")
    (tmp_path / "text.rrd").write_text("hello")
    assert "recording must be a file" in refusal(capsys, "none.rrd", "-o", "a.png")
    assert "is no Rerun recording" in refusal(capsys, "text.rrd", "-o", "a.png")
    assert "size must be 64 to 8192 pixels" in refusal(capsys, recording, "-o", "a.png", "--size", "10x10")
    assert "a picture must end in .png, got 'a.jpg'" in refusal(capsys, recording, "-o", "a.jpg")
    assert "ffmpeg is not installed" in refusal(capsys, recording, "-o", "a.mp4", "--fps", "10")
    assert "'no/a.png' cannot be written: there is no folder" in refusal(capsys, recording, "-o", "no/a.png")
    assert "'no/a' cannot be written: 'no' is no folder" in refusal(capsys, recording, "-o", "no/a", "--fps", "1")
    assert "'text.rrd/a' cannot be written" in refusal(capsys, recording, "-o", "text.rrd/a", "--fps", "1")
    for value in ("0", "-1", "nan"):
        assert f"fps must be > 0, got {value}" in refusal(capsys, recording, "-o", "a", "--fps", value)
        assert f"speed must be > 0, got {value}" in refusal(
            capsys, recording, "-o", "a", "--fps", "1", "--speed", value
        )
    assert "recording must be a file" in refusal(capsys, "none.rrd", "-o", "a", "--fps", "1")
    assert "recording must be a file" in refusal(capsys, "none.rrd")  # before the missing -o
    for wrong in ([], ["-o", "a.png", "--size", "big"], ["-o", "a", "--fps", "1", "--at", "2"]):
        try:
            status = main([str(recording), *wrong])
        except SystemExit as ended:  # of the parser
            status = ended.code
        assert status == 2, wrong
    assert list(tmp_path.iterdir()) == [tmp_path / "text.rrd"]
