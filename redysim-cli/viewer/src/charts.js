// The curves, with a line at the present time. A click or drag in them goes to that time.

import uPlot from "uplot";
import { colour, dash } from "./palette.js";
import { indexAt } from "./motion.js";

const HEIGHT = 132;
// A tenth more than the values at either end; left to itself, the library shows zeros on an axis to a hundred.
const range = (_, min, max) => (min === max && !min ? [-1, 1] : uPlot.rangeNum(min, max, 0.1, true));
const GRID = { stroke: "#e6e9ed", width: 1 };

export class Charts {
  /** Draws `charts` into `place`; calls `seek` with the time that is pointed at. */
  constructor(place, charts, seek) {
    this.charts = charts.map((chart) => new Chart(place, chart, seek));
    new ResizeObserver(() => this.charts.forEach((chart) => chart.resize())).observe(place);
  }

  show(time) {
    this.charts.forEach((chart) => chart.show(time));
  }
}

class Chart {
  constructor(place, { title, quantity, unit, t, curves }, seek) {
    this.figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    const measure = document.createElement("span");
    measure.textContent = ` [${unit}]`;
    caption.append(title, measure);
    this.figure.append(caption);
    place.append(this.figure);
    this.t = t;
    const series = curves.map((curve) => ({
      label: curve.name,
      stroke: colour(curve.colour),
      dash: dash(curve.colour),
      width: 1.6,
      points: { show: false },
      value: (_, value) => (value === null ? "–" : written(value, 4)),
    }));
    const axis = { stroke: "#5c6670", grid: GRID, ticks: GRID, font: "11px system-ui, sans-serif" };
    const options = {
      width: this.width,
      height: HEIGHT,
      scales: { x: { time: false }, y: { range } },
      // Whole pixels would make stairs of smooth curves.
      pxAlign: 0,
      series: [{}, ...series],
      axes: [
        { ...axis, size: 26, space: 72, values: (_, ticks) => ticks.map((tick) => `${written(tick, 12)} s`) },
        { ...axis, size: room, space: 22, values: (_, ticks) => ticks.map((tick) => written(tick, 12)) },
      ],
      padding: [8, 16, 0, 0],
      cursor: { show: false },
      legend: { live: true },
    };
    this.plot = new uPlot(options, [t, ...curves.map((curve) => curve.values)], this.figure);
    this.plot.over.setAttribute("role", "img");
    this.plot.over.setAttribute("aria-label", `${title}: ${quantity} in ${unit} over time`);
    this.now = document.createElement("div");
    this.now.className = "now";
    this.plot.over.append(this.now);
    this.#pointer(seek);
  }

  get width() {
    return Math.max(200, this.figure.clientWidth);
  }

  resize() {
    this.plot.setSize({ width: this.width, height: HEIGHT });
    this.show(this.time);
  }

  show(time) {
    this.time = time;
    this.now.style.transform = `translateX(${this.plot.valToPos(time, "x")}px)`;
    this.plot.setLegend({ idxs: this.plot.series.map(() => indexAt(this.t, time)) }, false);
  }

  #pointer(seek) {
    const { over } = this.plot;
    const go = (event) => seek(this.plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      go(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (over.hasPointerCapture(event.pointerId)) go(event);
    });
  }
}

/** The width of a vertical axis: that of its widest label with the tick, but usually the same in all charts. */
function room(plot, labels, index) {
  const { ctx, axes: { [index]: { font, ticks, gap } } } = plot;
  ctx.font = font[0];
  const widths = (labels ?? []).map((label) => ctx.measureText(label).width / devicePixelRatio);
  return Math.max(58, ...widths.map((width) => Math.ceil(width + ticks.size + gap + 2)));
}

/** A number with so many significant digits, in powers of ten where it is very small or large. */
function written(value, digits) {
  const number = Number(value.toPrecision(digits));
  const size = Math.abs(number);
  const usual = size === 0 || (size >= 1e-3 && size < 1e5);
  return (usual ? String(number) : number.toExponential().replace("e+", "e")).replaceAll("-", "−");
}
