"""Draws the times as an SVG: grouped bars over a logarithmic axis, a panel for each function."""

from math import floor, log10
from xml.sax.saxutils import escape

import robots
from programs import BY_KEY, FUNCTIONS, LANED
from results import Times

# Peers in cold and grey tones, redysim in warm ones.
SCALAR = {
    "pinocchio": "#9aa5b1",
    "mujoco": "#6b7785",
    "dynibo": "#7fb3b8",
    "cppadcodegen": "#3d7ea6",
    "casadi": "#7f9fd6",
    "generic": "#f0d9a8",
    "baseline_f64": "#f2a65a",
    "v3_f64": "#e57758",
    "native_f64": "#d1495b",
    "native_f32": "#8c2f39",
}
LANES = {"cppadcodegen_x8": "#3d7ea6", "f64x8": "#d1495b", "f32x16": "#8c2f39", "f64x4": "#d1495b", "f32x8": "#8c2f39"}
WIDTH, LEFT, RIGHT = 1120, 70, 20
PANEL, GAP, LEGEND = 250, 74, 62


class Drawing:
    def __init__(self):
        self.parts: list[str] = []

    def text(self, x: float, y: float, words: str, size: int = 13, anchor: str = "middle", more: str = "") -> None:
        self.parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" {more}>{escape(words)}</text>'
        )

    def box(self, x: float, y: float, width: float, height: float, colour: str) -> None:
        self.parts.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" fill="{colour}"/>')

    def line(self, y: float, colour: str) -> None:
        self.parts.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="{colour}" stroke-width="1" fill="none"/>')

    def legend(self, top: float, colours: dict[str, str]) -> None:
        x, y = float(LEFT), top
        for key, colour in colours.items():
            label = BY_KEY[key].label
            width = 40 + 7.6 * len(label)
            if x + width > WIDTH - RIGHT:
                x, y = float(LEFT), y + 22
            self.box(x, y - 11, 14, 14, colour)
            self.text(x + 20, y + 1, label, anchor="start")
            x += width

    def panel(
        self, top: float, title: str, unit: str, groups: list[tuple[str, dict[str, float]]], colours: dict
    ) -> None:
        """Bars by colour for each group: (name, time by key)."""
        values = [value for _, bars in groups for value in bars.values()]
        # From a decade below all bars to a bit above them, where their numbers stand.
        low, high = 10.0 ** floor(log10(min(values) * 0.95)), 1.9 * max(values)
        bottom = top + PANEL

        def height(value: float) -> float:
            return PANEL * (log10(value / low)) / log10(high / low)

        self.text(LEFT, top - 12, title, 15, "start", 'font-weight="bold"')
        self.parts.append(f'<g transform="translate(18 {top + PANEL / 2:.0f}) rotate(-90)">')
        self.text(0, 0, unit)
        self.parts.append("</g>")
        for decade in range(round(log10(low)), floor(log10(high)) + 1):
            y = bottom - height(10.0**decade)
            self.line(y, "#888" if decade == round(log10(low)) else "#ddd")
            self.text(LEFT - 8, y + 4, f"{10.0**decade:,.10g}", anchor="end")
            for minor in range(2, 10):
                if minor * 10.0**decade < high:
                    self.line(bottom - height(minor * 10.0**decade), "#f2f2f2")
        group_width = (WIDTH - LEFT - RIGHT) / len(groups)
        bar = min(group_width * 0.86 / len(colours), 26.0)
        for number, (name, bars) in enumerate(groups):
            middle = LEFT + group_width * (number + 0.5)
            for row, words in enumerate(name.split(", ")):
                self.text(middle, bottom + 20 + 16 * row, words)
            shown = [key for key in colours if key in bars]
            for place, key in enumerate(shown):
                x = middle + (place - len(shown) / 2) * bar
                tall = height(bars[key])
                self.box(x, bottom - tall, bar - 1, tall, colours[key])
                value = bars[key]
                label = f"{value:.1f}" if value < 9.95 else f"{value:.0f}"
                at = f'transform="rotate(-90 {x + bar / 2 + 3:.1f} {bottom - tall - 4:.1f})" fill="#444"'
                self.text(x + bar / 2 + 3, bottom - tall - 4, label, 10, "start", at)


def drawn(times: Times, titles: dict[str, str]) -> str:
    drawing = Drawing()
    names = [name for name in robots.NAMES if name in times.robots()]
    scalar = {key: colour for key, colour in SCALAR.items() if key in times.programs()}
    drawing.legend(24, scalar)
    top = LEGEND + 40
    for function, title in FUNCTIONS.items():
        groups = [(titles[name], _bars(times, scalar, name, function)) for name in names]
        drawing.panel(top, title[0].upper() + title[1:], "ns per call", groups, scalar)
        top += PANEL + GAP
    laned = [name for name in LANED if name in names]
    groups = [(f"{titles[n]}, {FUNCTIONS[f]}", _bars(times, LANES, n, f)) for n in laned for f in FUNCTIONS]
    groups = [(_short(name), bars) for name, bars in groups if bars]
    if groups:
        colours = {key: colour for key, colour in LANES.items() if any(key in bars for _, bars in groups)}
        drawing.legend(top, colours)
        drawing.panel(top + 44, "Several states at once", "ns per state", groups, colours)
        top += PANEL + GAP + 44
    style = 'font-family="\'DejaVu Sans\', Arial, sans-serif" fill="#222"'
    frame = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {top - 24:.0f}" {style}>'
    return "\n".join([frame, '<rect width="100%" height="100%" fill="#fff"/>', *drawing.parts, "</svg>", ""])


def _short(name: str) -> str:
    return name.replace(" dynamics", "").replace(" matrix", "")


def _bars(times: Times, colours: dict, robot: str, function: str) -> dict[str, float]:
    found = {key: times.of(key, robot, function) for key in colours}
    return {key: time for key, time in found.items() if time is not None}
