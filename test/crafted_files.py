# SPDX-License-Identifier: Apache-2.0
"""Files that were made to hang, to fill or to deceive a reader: each by a name that says what is wrong with it."""

import io
import json
import struct
import tempfile
import zipfile
import zlib
from pathlib import Path

import h5py
import numpy as np
from flow_files import write_flow

DEEP = 20_000
CELLS = (
    "",
    " ",
    "nan",
    "-inf",
    "1e308",
    "-1e308",
    "1e999",
    "0x10",
    "--1",
    "1e",
    "9" * 5000,
    "\0",
    "=1+1",
    "None",
    "1;5",
)


def tables(good: str) -> dict[str, bytes]:
    """Tables from a `good` one, whose first column is of numbers."""
    header, first, rest = good.split("\n", 2)
    names, last = header.split(","), rest.rstrip("\n").rpartition("\n")[2]
    made = {
        "empty": "",
        "blank": " \n",
        "header alone": header + "\n",
        "five million blank lines": header + "\n" * 5_000_001,
        "two million cells, one in a row": names[0] + "\n" + "1\n" * 2_000_000,
        "line of 2 MB": header + "\n" + "1" * 2_000_000,
        "field of 200 kB": good + "9" * 200_000 + last[last.index(",") :],
        "20,000 rows, each of a frame and a track of its own": "track,frame_idx,a.x,a.y,b.x,b.y\n"
        + "".join(f"{n},{n},1,2,3,4\n" for n in range(20_000)),
        "30,000 animals": "scorer"
        + ",s" * 60_000
        + "\nindividuals"
        + "".join(f",{n},{n}" for n in range(30_000))
        + "\nbodyparts"
        + ",a" * 60_000
        + "\ncoords"
        + ",x,y" * 30_000
        + ("\n0" + ",1" * 60_000),
        "200,000 columns": ",".join(map(str, range(200_000))) + "\n" + "0," * 199_999 + "0\n",
        "open quote": good + '"' + last,
        "open quote over many lines": good + '"' + (last + "\n") * 100_000,
        "a column twice": good.replace(names[-1], names[0], 1),
        "no first column": good.replace(names[0], "other", 1),
        "a field too many": good + last + ",0\n",
        "a field too few": good + last.rpartition(",")[0] + "\n",
        "text": good + last.replace(last.partition(",")[0], "high") + "\n",
        "zeros": "\0" * 100_000,
        "zeros at the end": good + "\0" * 100,
        "a zip": "PK\x03\x04" + good,
    }
    found = {name: text.encode() for name, text in made.items()}
    found |= {"Latin-1": good.encode() + b"\xe4\n", "UTF-16": good.encode("utf-16"), "noise": _noise(4000)}
    for cell in CELLS:
        for place in range(len(names)):
            fields = first.split(",")
            fields[place] = cell
            found[f"{cell[:8]!r} as {names[place]}"] = f"{header}\n{','.join(fields)}\n{rest}".encode()
    return found


def archives(good: dict[str, np.ndarray]) -> dict[str, bytes]:
    """Archives from the arrays of a `good` one."""
    name = next(iter(good))
    rest = {key: member(value) for key, value in good.items() if key != name}
    inflating = {"a member of 200 MB": (2 * 10**8, "<f8"), "40 million bytes": (4 * 10**7, "|u1")}
    wrong = {
        "1e12 elements": head("(1000000000000,)"),
        "1e30 elements": head(f"({10**30},)"),
        "10^4000 elements": head(f"({10**4000},)"),
        "a negative shape": head("(-1,)"),
        "a shape of a name": head("(x,)"),
        "a shape of brackets": head("(" * DEEP),
        "a head of brackets": b"[" * DEEP + b"\n",
        "an open text": b"{'descr': '<f8, \n",
        "an odd indent": b"{'descr':\n  '<f8'\n 1}\n",
        "a call": head("__import__('os').getpid()"),
        "objects": head("(4,)", "|O"),
        "texts": head("(4,)", "<U8"),
        "records": head("(4,)", "[('a','<f8')]"),
        "complex numbers": head("(4,)", "<c16"),
        "1,000 dimensions": head("(" + "1," * 1000 + ")"),
        "a dimension of none": head("(0, 1000000000000)"),
        "8-byte switches": head("(4,)", "|b8"),
        "16-byte floats": head("(4,)", "<f16"),
        "no kind": head("(4,)", ""),
        "voids": head("(4,)", "|V8"),
        "dates": head("(4,)", "<M8[s]"),
        "an open shape": head("(4")[:-5],
        "a shape in words": head("('four',)"),
        "a shape of 4,000 digits and a name": head("(" + "9" * 4000 + "x,)"),
        "another order": head("(4,)").replace(b"False", b"maybe"),
        "nothing": b"",
        "a head of zeros": b"\0" * 100,
    }
    whole = archive({name: member(good[name])} | rest)
    end = whole.rindex(b"PK\x05\x06")
    central = whole.index(b"PK\x01\x02")
    found = {f"an array of {kind}": archive({name: npy(text, bytes(32))} | rest) for kind, text in wrong.items()}
    found |= {
        kind: archive({name: npy(head(f"({size // int(dtype[2])},)", dtype), bytes(size))} | rest)
        for kind, (size, dtype) in inflating.items()
    }
    found |= {
        "empty": b"",
        "no member": archive({}),
        "no archive": b"time,x,y\n",
        "noise": _noise(4000),
        "noise behind the mark": b"PK\x03\x04" + _noise(4000),
        "an array twice": archive({name: member(good[name])} | rest, twice=name),
        "20,000 members": archive({str(number): b"" for number in range(20_000)}),
        "another checksum": _with(whole, central + 16, b"\1\2\3\4"),
        "another size": _with(whole, central + 24, b"\xff\xff\xff\x7f"),
        "encrypted": _with(whole, central + 8, b"\1\0"),
        "LZMA": archive({name: member(good[name])} | rest, zipfile.ZIP_LZMA),
        "BZ2": archive({name: member(good[name])} | rest, zipfile.ZIP_BZIP2),
        "an unknown compression": _with(whole, central + 10, b"\x63\0"),
        "a directory elsewhere": _with(whole, end + 16, b"\xff\xff\xff\x7f"),
        "a directory of 2 GB": _with(whole, end + 12, b"\xff\xff\xff\x7f"),
        "no directory": whole[:central],
        "no members": whole[central:],
        "half": whole[: len(whole) // 2],
        "999 columns of 5 million": archive(
            {"x": npy(head("(5000, 1000)"), bytes(4 * 10**7))} | {f"a{n}": member(np.zeros(1000)) for n in range(999)}
        ),
        "arrays that do not fit": archive({name: member(np.zeros((3, 5, 7)))} | rest),
        "not a number": archive({name: member(np.full(np.shape(good[name]), np.nan))} | rest),
        "1e308": archive({name: member(np.full(np.shape(good[name]), 1e308))} | rest),
    }
    return found


def sequences(good: str) -> dict[str, bytes]:
    """Sequences in YAML; a `good` one begins with the key steps."""
    laughs = "a0: &a0 [x, x, x, x, x, x, x, x]\n" + "".join(
        f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 8)}]\n" for n in range(1, 9)
    )
    mappings = "a0: &a0 {k: 1}\n" + "".join(
        f"a{n}: &a{n} {{{', '.join(f'k{m}: *a{n - 1}' for m in range(8))}}}\n" for n in range(1, 9)
    )
    merges = "a0: &a0 {k: 1}\n" + "".join(
        f"a{n}: &a{n} {{<<: [{', '.join([f'*a{n - 1}'] * 8)}]}}\n" for n in range(1, 9)
    )
    values = {
        "a duration of sixties": ":".join(["1"] * 200_000),
        "a duration of 400,000 digits": "1" * 400_000,
        "a duration of hexadecimal digits": "0x" + "f" * 400_000,
        "a duration that is no integer": "!!int ''",
        "a duration that is no date": "!!timestamp x",
        "a duration that is no switch": "!!bool x",
        "a duration that is not binary": "!!binary ']['",
        "a duration of the 99th": "2001-99-99",
        "a duration of an object": "!!python/object/apply:os.getpid []",
        "a duration of an unknown alias": "*x",
        "a duration beyond numbers": "1e999",
        "a duration of a set": "!!set {a, b}",
        "a duration of a deep list": "[" * DEEP,
    }
    made = {
        "empty": "",
        "a text": "swim",
        "a number": "3",
        "levels of brackets": "[" * DEEP,
        "closed levels of brackets": "steps: " + "[" * DEEP + "]" * DEEP,
        "levels of braces": "{" * DEEP,
        "levels of keys": "steps: " + "{a: " * DEEP + "}" * DEEP,
        "levels of dashes": "- " * DEEP,
        "levels of indents": "".join(" " * n + "a:\n" for n in range(900)),
        "levels of question marks": "? " * DEEP,
        "aliases of lists": laughs + good,
        "aliases of mappings": mappings + good,
        "merged aliases": merges + good,
        "an alias of itself": "steps: &a [*a]",
        "a key of itself": "&a ? *a\n: 1\n",
        "30,000 keys": "".join(f"k{n}: 1\n" for n in range(30_000)),
        "30,000 steps": "steps:\n" + "- {gait: still, duration: 1}\n" * 16_000,
        "600 kB": "steps: " + "x" * 600_000,
        "a comment of 400 kB": "#" * 400_000,
        "tabs": "\tsteps:\n\t- 1",
        "zeros": "\0" * 1000,
        "two documents": good + "---\n" + good,
        "another version": "%YAML 9.9\n---\n" + good,
        "a wrong directive": "%TAG\n---\n" + good,
        "a key twice": good + good,
        "a list as key": "[1, 2]: 3\n" + good,
        "repeats of repeats": "steps:\n- "
        + "repeat: 1000\n".join("  " * n + ("  steps:\n" + "  " * n + "  - " if n else "") for n in range(7))
        + "gait: still\n",
        "a tag of no library": good.replace("still", "!!python/name:os.system x"),
        "no key": "null: 1\n",
        "a number as key": "1.5: 1\n",
        "a switch as key": "true: 1\n",
        "surrogates": '"\\ud800": 1',
        "escapes": '"\\UFFFFFFFF": 1',
    }
    made |= {name: good.replace("duration: 1", f"duration: {text}") for name, text in values.items()}
    found = {name: text.encode() for name, text in made.items()}
    return found | {
        "Latin-1": good.encode() + b"# \xe4\n",
        "UTF-16": good.encode("utf-16"),
        "noise": _noise(4000),
        "control characters": b"\x1b[2J\x07: 1\n",
        "a mark of bytes in the middle": good.encode() + b"\xef\xbb\xbf: 1",
    }


def texts_of_json(good: str) -> dict[str, bytes]:
    """Texts of JSON from a `good` one, an object of objects."""
    inner = json.loads(good)
    key = next(iter(inner))
    values = {"a list": [], "a text": "x", "a number": 1.5, "a switch": True, "an empty object": {}, "1e308": 1e308}
    made = {
        "empty": "",
        "levels": "[" * DEEP,
        "closed levels": "[" * DEEP + "]" * DEEP,
        "levels of objects": '{"a":' * DEEP,
        "3 million lists": "[" + "[]," * 3_000_000 + "[]]",
        "400,000 digits": f'{{"{key}": {"1" * 400_000}}}',
        "a list of all": f"[{good}]",
        "NaN": f'{{"{key}": NaN}}',
        "a surrogate": '{"\\ud800": "\\udc00"}',
        "half": good[: len(good) // 2],
        "twice": good + good,
        "zeros": "\0" * 1000,
        "none": "null",
    } | {f"{name} as {key}": json.dumps(inner | {key: value}) for name, value in values.items()}
    return {name: text.encode() for name, text in made.items()} | {"noise": _noise(1000), "Latin-1": b'{"\xe4": 1}'}


def runs(good: bytes) -> dict[str, bytes]:
    """netCDF files from a `good` one, of a run or a batch: its head, its text and its arrays."""
    start = good.index(b"eel\0") + 12
    size = struct.unpack(">i", good[start - 4 : start])[0]
    text = good[start : start + size].decode()
    found = {
        f"a text of JSON: {name}": _with_text(good, start, size, each) for name, each in texts_of_json(text).items()
    }
    about = json.loads(text)
    for key in about:
        for wrong in (None, [], {}, "x", -1, 1e308, {"terms": []}, [[[]]]):
            changed = json.dumps(about | {key: wrong}).encode()
            found[f"{json.dumps(wrong)} as {key}"] = _with_text(good, start, size, changed)
    return found | heads(good)


def heads(good: bytes) -> dict[str, bytes]:
    """netCDF files from a `good` one with another head."""
    found, variable, million = {}, good.index(b"\0\0\0\x0b"), struct.pack(">iii", 0, 10, 10**6)
    for place, what in ((4, "samples"), (8, "dimensions"), (12, "number of dimensions")):
        for number in (-1, 0, 1, 2**31 - 1):
            found[f"{number} as {what}"] = _with(good, place, struct.pack(">i", number))
    found |= {
        "empty": b"",
        "the mark alone": b"CDF\x02",
        "version 1": _with(good, 3, b"\1"),
        "version 5": _with(good, 3, b"\5"),
        "HDF5": b"\x89HDF\r\n\x1a\n" + _noise(4000),
        "noise": b"CDF\x02" + _noise(4000),
        "zeros": b"CDF\x02" + bytes(100_000),
        "a million dimensions": _with(b"CDF\x02" + (struct.pack(">i", 4) + b"abcd\0\0\0\1") * 10**6, 4, million),
        "a million variables": _with(good, variable + 4, struct.pack(">i", 10**6)),
        "variables over one another": _overlaid(4000, 1_000_000),
        "none of everything": _overlaid(1, 0),
        "half": good[: len(good) // 2],
        "no last byte": good[:-1],
    }
    for part in range(8):
        found[f"noise in part {part} of the head"] = _with(good, 16 + part * variable // 8, _noise(16))
    return found


def of_hdf5(good: bytes) -> dict[str, bytes]:
    """Files of HDF5 from a `good` one: each of its data sets with a shape that it does not hold, or a swollen chunk."""
    found = {
        "empty": b"",
        "the mark alone": good[:8],
        "noise": good[:8] + _noise(4000),
        "noise in the middle": _with(good, len(good) // 2, _noise(200)),
        "zeros": good[:8] + bytes(100_000),
        "half": good[: len(good) // 2],
        "no last byte": good[:-1],
        "no HDF5": b"time,x,y\n",
    }
    names, swollen = list[str](), zlib.compress(bytes(3 * 10**8), 1)
    with h5py.File(io.BytesIO(good)) as file:
        file.visititems(lambda name, each: names.append(name) if getattr(each, "shape", ()) else None)
    for name in names:
        for kind, shape, chunk in (
            ("1e15 numbers", 10**15, 1000),
            ("3e7 numbers that are not there", 3 * 10**7, 1000),
            ("a chunk of 1 GB", 1, 10**8),
            ("a chunk that inflates to 300 MB", 1000, 1000),
        ):
            content = io.BytesIO(good)
            with h5py.File(content, "r+") as file:
                dims, dtype, attributes = file[name].ndim, file[name].dtype, dict(file[name].attrs)
                del file[name]
                shape_of, chunk_of = ((each, *(1,) * (dims - 1)) for each in (shape, chunk))
                data = file.create_dataset(
                    name, shape_of, dtype, chunks=chunk_of, maxshape=(None,) * dims, compression="gzip"
                )
                data.attrs.update({key: value for key, value in attributes.items() if "LIST" not in key})
                if kind.startswith("a chunk that"):
                    data.id.write_direct_chunk((0,) * dims, swollen)
            found[f"{kind} as {name}"] = content.getvalue()
    return found


def flows(good: bytes) -> dict[str, bytes]:
    """Flows in netCDF from a `good` one, some with dimensions that spread small variables over many points."""
    found = heads(good)
    with tempfile.TemporaryDirectory() as folder:
        for count in (41, 54, 150):
            write_flow(path := Path(folder) / "flow.nc", count)
            found[f"{count} points along each of four axes"] = path.read_bytes()
    return found


def member(values: np.ndarray) -> bytes:
    """An array as a member of an archive."""
    file = io.BytesIO()
    np.save(file, values)
    return file.getvalue()


def head(shape: str, dtype: str = "<f8") -> bytes:
    """The head of an array as NumPy writes it."""
    return f"{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}\n".encode()


def npy(text: bytes, content: bytes) -> bytes:
    """A member with this head."""
    return b"\x93NUMPY\2\0" + len(text).to_bytes(4, "little") + text + content


def archive(members: dict[str, bytes], compression: int = zipfile.ZIP_DEFLATED, twice: str | None = None) -> bytes:
    """An .npz archive."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", compression, compresslevel=1) as written:
        for name, content in members.items():
            written.writestr(f"{name}.npy", content)
    whole = file.getvalue()
    if twice is not None:  # the second has the first's name, and is told from it by nothing
        other = next(name for name in members if name != twice)
        whole = archive({name if name != other else "?" * len(twice): each for name, each in members.items()})
        whole = whole.replace(b"?" * len(twice) + b".npy", f"{twice}.npy".encode())
    return whole


def flipped(whole: bytes, count: int, seed: int) -> dict[str, bytes]:
    """`count` files with one flipped bit each."""
    draw, found = np.random.default_rng(seed), {}
    for place in draw.choice(8 * len(whole), min(count, 8 * len(whole)), replace=False).tolist():
        byte, bit = divmod(place, 8)
        changed = bytearray(whole)
        changed[byte] ^= 1 << bit
        found[f"bit {bit} of byte {byte}"] = bytes(changed)
    return found


def _overlaid(count: int, size: int) -> bytes:
    """A netCDF file of `count` variables that are all the same `size` bytes."""
    name = struct.pack(">ii", 1, 0) if not size else b""
    dimensions = struct.pack(">ii", 10, 1) + struct.pack(">i", 1) + b"d\0\0\0" + struct.pack(">i", size or 2**31 - 1)
    length = 40 * count + 100
    variables = b"".join(
        struct.pack(">i", 4) + f"{n:04d}".encode() + struct.pack(">iiiiiiq", 1, 0, 0, 0, 1, size, length)
        for n in range(count)
    )
    start = b"CDF\x02" + struct.pack(">i", 0) + dimensions + struct.pack(">ii", 0, 0)
    return start + struct.pack(">ii", 11, count) + variables + bytes(size + 200) + name


def _with_text(good: bytes, start: int, size: int, text: bytes) -> bytes:
    """The file with another JSON text. What follows is moved, so the variables' places are raised."""
    padded = text + bytes(-len(text) % 4)
    old = size + -size % 4
    whole = good[: start - 4] + struct.pack(">i", len(text)) + padded + good[start + old :]
    shift, first = len(padded) - old, good.index(b"\0\0\0\x0b", start)
    ends = _places(good, first)
    for place in ends:
        begin = struct.unpack(">q", good[place : place + 8])[0]
        whole = _with(whole, place + shift, struct.pack(">q", begin + shift))
    return whole


def _places(good: bytes, first: int) -> list[int]:
    """Where the variables' places stand in a file of version 2 whose list of variables is at `first`."""
    at, found = first + 8, []

    def number() -> int:
        nonlocal at
        at += 4
        return struct.unpack(">i", good[at - 4 : at])[0]

    for _ in range(struct.unpack(">i", good[first + 4 : first + 8])[0]):
        length = number()
        at += length + -length % 4
        dimensions = number()
        at += 4 * dimensions
        number()
        for _ in range(number()):
            length = number()
            at += length + -length % 4
            number()
            length = number()
            at += length + -length % 4
        at += 8
        found.append(at)
        at += 8
    return found


def _with(whole: bytes, place: int, content: bytes) -> bytes:
    return whole[:place] + content + whole[place + len(content) :]


def _noise(size: int) -> bytes:
    return np.random.default_rng(size).bytes(size)
