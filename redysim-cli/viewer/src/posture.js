// A position that is changed coordinate by coordinate, with the loops closed.

/** The largest part of a change that is made at once, rad or lengths of the mechanism: loops stay on their branch. */
const STEP = 0.05;
/** The smallest: where even this does not close the loops, they cannot be closed. */
const FINEST = 1e-6;
/** A coordinate that moves further in a step, rad or lengths of the mechanism, has left its branch. */
const LEAP = 0.5;
/** Parts of a slider by which each coordinate is moved to see how much room there must be around the start. */
const ROOM = [-0.25, 0.25];

export class Posture {
  /** `sliders`, the coordinates with their limits and starts; `length`, the size of the mechanism, m. */
  constructor(sliders, linkage, loops, length) {
    Object.assign(this, { sliders, linkage, loops });
    this.start = sliders.map(({ start }) => start);
    this.units = sliders.map(({ unit }) => (unit === "m" ? length : 1));
    /** Whether the loops are closed: a model whose loops cannot be is moved as the tree that it is without them. */
    this.closed = loops.isClosed(this.start);
    this.reset();
  }

  reset() {
    this.#take(this.start.slice());
  }

  /** Moves a coordinate to `value`, or as far towards it as the others can follow; null, or what stopped it. */
  move(coordinate, value) {
    if (!this.closed) {
      this.#take(this.q.with(coordinate, value));
      return null;
    }
    const way = value - this.q[coordinate];
    // The short way, for a joint that turns around.
    const goal = this.q[coordinate] + (this.sliders[coordinate].limits === "turn" ? withinATurn(way) : way);
    let [step, stopped] = [STEP, null];
    while (this.q[coordinate] !== goal && (!stopped || step > FINEST)) {
      const left = goal - this.q[coordinate];
      const most = step * this.units[coordinate];
      const next = Math.abs(left) <= most ? goal : this.q[coordinate] + Math.sign(left) * most;
      const closed = this.loops.close(this.q.with(coordinate, next), coordinate);
      stopped = this.#obstacle(closed);
      if (stopped) step /= 2;
      else {
        this.q = closed;
        step = Math.min(2 * step, STEP);
      }
    }
    this.#take(this.q);
    return stopped;
  }

  /** Calls `look` at positions around the start, where loops may be open, and goes back. */
  visit(look) {
    this.sliders.forEach(({ least, largest }, coordinate) => {
      for (const part of ROOM) {
        this.linkage.place(this.start.with(coordinate, this.start[coordinate] + part * (largest - least)));
        look();
      }
    });
    this.stand(look);
  }

  /** Calls `look` where the mechanism must be above the ground. */
  stand(look) {
    this.linkage.place(this.start);
    look();
    this.linkage.place(this.q);
  }

  /** Why the loops cannot go on to `closed` in one step. */
  #obstacle(closed) {
    const far = (value, coordinate) => Math.abs(value - this.q[coordinate]) > LEAP * this.units[coordinate];
    if (!closed || closed.some(far)) return { loops: true };
    const out = this.sliders.findIndex(({ limits, least, largest }, coordinate) => {
      const beyond = (q) => Math.max(least - q, q - largest, 0);
      return limits === "range" && beyond(closed[coordinate]) > beyond(this.q[coordinate]) + 1e-12;
    });
    return out < 0 ? null : { range: out };
  }

  /** Joints that turn around are where they are after whole turns. */
  #take(q) {
    this.q = q.map((value, coordinate) => (this.sliders[coordinate].limits === "turn" ? withinATurn(value) : value));
    this.linkage.place(this.q);
  }
}

/** The same angle from −π to π. */
function withinATurn(angle) {
  return Math.abs(angle) <= Math.PI ? angle : angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}
