// Sliders for the coordinates, and what stops them.

export class Sliders {
  /** Calls `show` whenever the posture has changed. `names` are those of the coordinates. */
  constructor(place, names, posture, show) {
    Object.assign(this, { names, posture, show });
    this.status = document.createElement("p");
    this.status.setAttribute("role", "status");
    this.rows = names.map((name, coordinate) => this.#row(name, coordinate));
    const zero = document.createElement("button");
    zero.textContent = "Back to the start";
    zero.addEventListener("click", () => this.reset());
    place.append(...this.rows.map(({ label }) => label), zero, this.status);
    this.reset();
  }

  reset() {
    this.posture.reset();
    this.#shown(null);
  }

  /** Moves a coordinate as its slider does, and the others with it as far as loops ask for. */
  move(coordinate, value) {
    const stopped = this.posture.move(coordinate, value);
    this.#shown(stopped && this.#why(coordinate, stopped));
  }

  #row(name, coordinate) {
    const { least, largest } = this.posture.sliders[coordinate];
    const label = document.createElement("label");
    const [text, value, input] = ["span", "output", "input"].map((tag) => document.createElement(tag));
    text.textContent = name;
    Object.assign(input, { type: "range", step: "any", min: least, max: largest });
    input.title = `${this.#measure(coordinate, least)} to ${this.#measure(coordinate, largest)}`;
    input.addEventListener("input", () => this.move(coordinate, Number(input.value)));
    label.append(text, value, input);
    return { label, input, value };
  }

  /** Shows where every coordinate is, and `why` one of them stopped. */
  #shown(why) {
    this.rows.forEach(({ input, value }, coordinate) => {
      const q = this.posture.q[coordinate];
      input.value = q;
      const text = this.#measure(coordinate, q);
      input.setAttribute("aria-valuetext", text);
      value.textContent = text;
    });
    this.status.textContent = why ?? "";
    this.show();
  }

  #why(coordinate, { range }) {
    const at = `${this.names[coordinate]} stops at ${this.#measure(coordinate, this.posture.q[coordinate])}: beyond it, `;
    return at + (range === undefined ? "the loops cannot be closed." : `${this.names[range]} leaves its range.`);
  }

  /** An angle in degrees, or a value in its own unit. */
  #measure(coordinate, value) {
    const { unit } = this.posture.sliders[coordinate];
    const degrees = () => `${((180 / Math.PI) * value).toFixed(1)}°`;
    const text = unit === "rad" ? degrees() : `${value.toFixed(4)} ${unit}`;
    return text.replace("-", "−");
  }
}
