# SPDX-License-Identifier: Apache-2.0
"""Texts drawn as lines, in two dimensions and in three.

The viewer's own labels have a background in the colour of the viewer's theme. A label that is light enough for the dark
theme cannot be read in the light one. These letters have their own colour and background in both. The text itself is
kept as the labels of the lines, which are not shown.

The letters are Hershey's simplex Roman ones, by A. V. Hershey of the U.S. National Bureau of Standards, in the
transcription of J. Hurt, Cognition Inc. They may be used freely with this acknowledgement.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import rerun as rr

from eel_viz.scene3d import colours
from eel_viz.scene3d.colours import Colour

# One line per letter: the letter, its width, its strokes. A digit n of a width or coordinate is the character 40 + n;
# points are pairs of digits, x to the right and y up; y = DESCENT is the line on which letters stand.
ZERO, DESCENT, CAPITAL, SPACE, UNKNOWN = 40, 7, 21.0, 14.0, "?"  # units of the letters; CAPITAL: height of a capital
_LETTERS = """\
( 6 3H1F/C-?,:,6-1/-1*3(
) 6 +H-F/C1?2:2611/--*+(
* 8 0>02 +;55 5;+5
+ B 5A5/ ,8>8
, 0 -3,2+3,4-3-1+/
- B ,8>8
. 0 ,4+3,2-3,4
/ > <H*(
0 < 1D.C,@+;+8,3.01/3/6083989;8@6C3D1D
1 < .@0A3D3/
2 < ,?,@-B.C0D4D6C7B8@8>7<59+/9/
3 < -D8D2<5<7;8:979582603/0/-0,1+3
4 < 5D+6:6 5D5/
5 < 7D-D,;-<0=3=6<8:979582603/0/-0,1+3
6 < 8A7C4D2D/C-@,;,6-2/02/3/60829596896;3<2</;-9,6
7 < 9D// +D9D
8 < 0D-C,A,?-=/<3;6:88969381704/0/-0,1+3+6,8.:1;5<7=8?8A7C4D0D
9 < 8=7:582717.8,:+=+>,A.C1D2D5C7A8=8873502/0/-0,2
: 0 ,;+:,9-:,; ,4+3,2-3,4
; 0 ,;+:,9-:,; -3,2+3,4-3-1+/
< @ <A,8</
= B ,;>; ,5>5
> @ ,A<8,/
? : +?+@,B-C/D3D5C6B7@7>6<5;1916 11001/2011
[ 6 ,H,( -H-( ,H3H ,(3(
] 6 1H1( 2H2( +H2H +(2(
^ 8 0F(8 0F88
_ : ((:(
% @ =D+/ 0D2B2@1>/=-=+?+A,C.D0D2C5B8B;C=D 967563618/:/<0=2=4;696
A : 1D)/ 1D9/ ,666
B = ,D,/ ,D5D8C9B:@:>9<8;5: ,:5:8998:6:391805/,/
C = :?9A7C5D1D/C-A,?+<+7,4-2/01/5/7092:4
D = ,D,/ ,D3D6C8A9?:<:79482603/,/
E ; ,D,/ ,D9D ,:4: ,/9/
F : ,D,/ ,D9D ,:4:
G = :?9A7C5D1D/C-A,?+<+7,4-2/01/5/7092:4:7 57:7
H > ,D,/ :D:/ ,:::
I 0 ,D,/
J 8 4D4431200/./,0+1*4*6
K = ,D,/ :D,6 1;:/
L 9 ,D,/ ,/8/
M @ ,D,/ ,D4/ <D4/ <D</
N > ,D,/ ,D:/ :D:/
O > 1D/C-A,?+<+7,4-2/01/5/7092:4;7;<:?9A7C5D1D
P = ,D,/ ,D5D8C9B:@:=9;8:59,9
Q > 1D/C-A,?+<+7,4-2/01/5/7092:4;7;<:?9A7C5D1D 43:-
R = ,D,/ ,D5D8C9B:@:>9<8;5:,: 3::/
S < 9A7C4D0D-C+A+?,=-</;5978879592704/0/-0+2
T 8 0D0/ )D7D
U > ,D,5-2/02/4/7092:5:D
V : )D1/ 9D1/
W @ *D// 4D// 4D9/ >D9/
X < +D9/ 9D+/
Y : )D1:1/ 9D1:
Z < 9D+/ +D9D +/9/
a ; 7=7/ 7:5<3=0=.<,:+7+5,2.00/3/5072
b ; ,D,/ ,:.<0=3=5<7:878572503/0/.0,2
c : 7:5<3=0=.<,:+7+5,2.00/3/5072
d ; 7D7/ 7:5<3=0=.<,:+7+5,2.00/3/5072
e : +777796;5<3=0=.<,:+7+5,2.00/3/5072
f 4 2D0D.C-@-/ *=1=
g ; 7=7-6*5)3(0(.) 7:5<3=0=.<,:+7+5,2.00/3/5072
h ; ,D,/ ,9/<1=4=6<797/
i 0 +D,C-D,E+D ,=,/
j 2 -D.C/D.E-D .=.,-)+()(
k 9 ,D,/ 6=,3 077/
l 0 ,D,/
m F ,=,/ ,9/<1=4=6<797/ 79:<<=?=A<B9B/
n ; ,=,/ ,9/<1=4=6<797/
o ; 0=.<,:+7+5,2.00/3/507285877:5<3=0=
p ; ,=,( ,:.<0=3=5<7:878572503/0/.0,2
q ; 7=7( 7:5<3=0=.<,:+7+5,2.00/3/5072
r 5 ,=,/ ,7-:/<1=4=
s 9 6:5<2=/=,<+:,8.736556362502///,0+2
t 4 -D-3.00/2/ *=1=
u ; ,=,3-0//2/4073 7=7/
v 8 *=0/ 6=0/
w > +=// 3=// 3=7/ ;=7/
x 9 +=6/ 6=+/
y 8 *=0/ 6=0/.+,)*()(
z 9 6=+/ +=6= +/6/
| 0 ,H,(
~ @ +5+7,:.;0;2:6786:6<7=9 +7,9.:0:296685:5<6=9=;
' 2 -B,C-D.C.A-?,>
"""


def _read(line: str) -> tuple[float, list[np.ndarray]]:
    width, *strokes = line[2:].split(" ")
    points = [np.array([*map(ord, stroke)], dtype=float).reshape(-1, 2) - (ZERO, ZERO + DESCENT) for stroke in strokes]
    return float(ord(width) - ZERO), points


GLYPHS: dict[str, tuple[float, list[np.ndarray]]] = {" ": (SPACE, [])} | {
    line[0]: _read(line) for line in _LETTERS.splitlines()
}


def strokes_of(text: str, align: float = 0.5) -> list[np.ndarray]:
    """Polylines (n, 2) of `text` in heights of a capital, x to the right and y up.

    The middle of the capitals is y = 0. align: the share of the width to the left of x = 0.
    """
    at, found = 0.0, []
    for letter in text:
        width, strokes = GLYPHS.get(letter, GLYPHS[UNKNOWN])
        found += [stroke + np.array((at, -CAPITAL / 2)) for stroke in strokes]
        at += width
    return [(stroke - (align * at, 0.0)) / CAPITAL for stroke in found]


def flat_texts(
    places: Any, texts: Sequence[str], height: float, shades: Sequence[Colour] = (), align: float = 0.5, **more: Any
) -> rr.LineStrips2D:
    """The `texts` with their middles at `places` (n, 2) of a drawing whose y points down. height: of a capital."""
    strips, colour = _placed(places, texts, np.array(((height, 0.0), (0.0, -height))), shades, align)
    return rr.LineStrips2D(strips, labels=list(texts), show_labels=False, colors=colour, radii=STROKE, **more)


def standing_texts(
    places: Any, texts: Sequence[str], right: np.ndarray, up: np.ndarray, shades: Sequence[Colour] = (), **more: float
) -> rr.LineStrips3D:
    """The `texts` at `places` (n, 3). right, up: directions of their letters, (3,) or (n, 3), as long as capitals."""
    strips, colour = _placed(places, texts, np.stack(np.broadcast_arrays(right, up), axis=-2), shades, **more)
    return rr.LineStrips3D(strips, labels=list(texts), show_labels=False, colors=colour, radii=STROKE)


STROKE = rr.Radius.ui_points(0.65)


def _placed(
    places: Any, texts: Sequence[str], axes: np.ndarray, shades: Sequence[Colour], align: float = 0.5
) -> tuple[Any, list[Colour]]:
    strips, colour = [], []
    axes, shades = np.broadcast_to(axes, (len(texts), *axes.shape[-2:])), shades or [colours.LABEL] * len(texts)
    for place, text, plane, shade in zip(places, texts, axes, shades, strict=True):
        strokes = [(np.asarray(place) + stroke @ plane).astype(np.float32) for stroke in strokes_of(text, align)]
        strips += strokes
        colour += [shade] * len(strokes)
    return strips, colour
