"""How the figures look: colours, dashes, and the settings of matplotlib.

Colours are those of Okabe and Ito, distinct for colour-blind eyes, with another dash each for print without colour;
maps of colour are perceptually even (cividis) or diverging without red and green (PuOr).
"""

BLACK, BLUE, ORANGE, GREEN, PURPLE = "#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7"
PALE_BLUE, GREY = "#d9e6f0", "#888888"
OWN = {"color": BLUE, "linewidth": 1.6, "label": "corrected"}
AS_PRINTED = {"color": ORANGE, "linewidth": 1.2, "linestyle": (0, (4, 2)), "label": "as printed"}
SETTINGS = {
    "font.size": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.fontsize": "small",
    "mathtext.fontset": "dejavusans",
    "svg.hashsalt": "eel",  # the same file each time
    "figure.dpi": 100,
    "savefig.dpi": 100,
}
PITCH_RAMPS = ((1.0, 3.0), (6.0, 8.0))  # s, while the falling gait bends in pitch: t1 to t3 and t4 to t6


def mark_pitch(panels):
    """Shade the time in which the falling gait bends in pitch."""
    for axes in panels:
        for start, end in PITCH_RAMPS:
            axes.axvspan(start, end, color=GREY, alpha=0.12, linewidth=0)


def plain(axes):
    """A grid, and no margin left and right."""
    axes.grid(alpha=0.3)
    axes.margins(x=0.0)
