// Closed loops: how far cut joints are apart, and the coordinates that close them (Levenberg-Marquardt).

import { Quaternion, Vector3 } from "three";

/** Loops are closed if no row of the residual is larger than this part of the mechanism's size. */
const CLOSED = 1e-10;
const ITERATIONS = 30;
/** The least damping, as part of the mean diagonal element of JᵀJ: steps are as short as they can be. */
const DAMPING = 1e-12;
/** The largest component of a step, rad or m: far below the distance of assembly modes. */
const LARGEST_STEP = 0.2;

export class Loops {
  /** `size` is the length of the mechanism, m. */
  constructor(cuts, linkage, size) {
    this.linkage = linkage;
    this.tolerance = CLOSED * size;
    this.cuts = cuts.map(({ kind, a, b }) => ({ kind, a: this.#side(a), b: this.#side(b) }));
  }

  /** The largest component of the residual, m or a sine. */
  gap(q) {
    return largest(this.#residual(q));
  }

  isClosed(q) {
    return this.gap(q) <= this.tolerance;
  }

  /** The coordinates near `q` that close the loops with the coordinate `held` as it is; null if none do. */
  close(q, held) {
    const free = [...q.keys()].filter((coordinate) => coordinate !== held);
    let residual = this.#residual(q);
    let damping = DAMPING;
    for (let iteration = 0; iteration < ITERATIONS && largest(residual) > this.tolerance; iteration++) {
      this.linkage.place(q);
      const jacobian = this.#jacobian(q);
      const step = leastSquares(jacobian, residual, free, damping);
      const part = Math.min(1, LARGEST_STEP / largest(step));
      const next = q.slice();
      free.forEach((coordinate, index) => (next[coordinate] -= part * step[index]));
      const there = this.#residual(next);
      if (norm(there) < norm(residual)) {
        [q, residual] = [next, there];
        damping = Math.max(damping / 10, DAMPING);
      } else if (damping < 1) damping *= 10;
      else break;
    }
    return largest(residual) <= this.tolerance ? q : null;
  }

  /** A side of a cut: its point, and the directions that the other side's meet. */
  #side({ body, point, rotation }) {
    const carriers = new Set(this.linkage.carriers(body));
    const axes = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
    const turn = new Quaternion(...rotation);
    return { body, carriers, point: new Vector3(...point), axes: axes.map((each) => each.applyQuaternion(turn)) };
  }

  /** Of each cut, the way from point a to point b, or along which axes of a it vanishes; then the products of axes that
   * vanish when they are aligned. */
  #residual(q) {
    this.linkage.place(q);
    return this.cuts.flatMap(({ kind, a, b }) => {
      const [of, to] = [this.#axes(a), this.#axes(b)];
      const way = this.#point(b).sub(this.#point(a));
      const apart = ALONG[kind] ? ALONG[kind].map((i) => way.dot(of[i])) : way.toArray();
      const aligned = ALIGNED[kind].map((terms) => weighted(terms, (i, j) => of[i].dot(to[j])));
      return [...apart, ...aligned];
    });
  }

  /** By how much each row of the residual changes with each coordinate. */
  #jacobian(q) {
    const rows = [];
    for (const { kind, a, b } of this.cuts) {
      const first = rows.length;
      const points = ALONG[kind]?.length ?? 3;
      for (let row = 0; row < points + ALIGNED[kind].length; row++) rows.push(new Float64Array(q.length));
      const [from, to] = [this.#point(a), this.#point(b)];
      const [of, at] = [this.#axes(a), this.#axes(b)];
      this.linkage.joints.forEach((_, link) => {
        const [onA, onB] = [a.carriers.has(link), b.carriers.has(link)];
        if (!onA && !onB) return;
        const { position } = this.linkage.poses[link + 1];
        for (const { coordinate, spin, slide } of this.linkage.freedoms(link, q)) {
          const velocity = (point) => new Vector3().crossVectors(spin, point.clone().sub(position)).add(slide);
          const change = new Vector3();
          if (onB) change.add(velocity(to));
          if (onA) change.sub(velocity(from));
          // Along an axis of side a, what carries a turns the axis as well.
          const turned = onA ? new Vector3().crossVectors(spin, to.clone().sub(from)) : new Vector3();
          const moved = ALONG[kind] ? ALONG[kind].map((i) => change.clone().sub(turned).dot(of[i])) : change.toArray();
          moved.forEach((value, row) => (rows[first + row][coordinate] += value));
          if (onA && onB) continue;
          const rate = (i, j) =>
            onA
              ? new Vector3().crossVectors(spin, of[i]).dot(at[j])
              : of[i].dot(new Vector3().crossVectors(spin, at[j]));
          ALIGNED[kind].forEach((terms, row) => (rows[first + points + row][coordinate] += weighted(terms, rate)));
        }
      });
    }
    return rows;
  }

  #point({ body, point }) {
    const { position, rotation } = this.linkage.poses[body];
    return point.clone().applyQuaternion(rotation).add(position);
  }

  #axes({ body, axes }) {
    const { rotation } = this.linkage.poses[body];
    return axes.map((axis) => axis.clone().applyQuaternion(rotation));
  }
}

/** Along which axes of side a the points are not apart, of cuts in which they may be apart along the others. */
const ALONG = { prismatic: [0, 1], cylindrical: [0, 1], planar: [2] };

const AXES = [[[1, 0, 2]], [[1, 1, 2]]];
const FRAMES = [[[0.5, 2, 1], [-0.5, 1, 2]], [[0.5, 0, 2], [-0.5, 2, 0]], [[0.5, 1, 0], [-0.5, 0, 1]]];
/** Sums of factor times axis i of side a by axis j of side b, as `CutKind::rows` has them. */
const ALIGNED = {
  spherical: [],
  universal: [[[1, 2, 2]]],
  revolute: AXES,
  cylindrical: AXES,
  planar: AXES,
  prismatic: FRAMES,
  weld: FRAMES,
};

function weighted(terms, term) {
  return terms.reduce((sum, [factor, i, j]) => sum + factor * term(i, j), 0);
}

/** The damped least-squares solution of J x = r over the `free` columns: (JᵀJ + d 1) x = Jᵀ r, by Cholesky. */
function leastSquares(jacobian, residual, free, damping) {
  const normal = free.map(() => new Float64Array(free.length));
  const right = new Float64Array(free.length);
  jacobian.forEach((row, index) => {
    const values = free.map((coordinate) => row[coordinate]);
    values.forEach((value, i) => {
      if (!value) return;
      right[i] += value * residual[index];
      for (let j = 0; j <= i; j++) normal[i][j] += value * values[j];
    });
  });
  const mean = normal.reduce((sum, row, i) => sum + row[i], 0) / Math.max(1, free.length);
  normal.forEach((row, i) => (row[i] += damping * mean || 1));
  for (let i = 0; i < free.length; i++) {
    for (let j = 0; j <= i; j++) {
      let sum = normal[i][j];
      for (let k = 0; k < j; k++) sum -= normal[i][k] * normal[j][k];
      normal[i][j] = i === j ? Math.sqrt(Math.max(sum, damping * mean || 1)) : sum / normal[j][j];
    }
  }
  for (let i = 0; i < free.length; i++) {
    for (let k = 0; k < i; k++) right[i] -= normal[i][k] * right[k];
    right[i] /= normal[i][i];
  }
  for (let i = free.length - 1; i >= 0; i--) {
    for (let k = i + 1; k < free.length; k++) right[i] -= normal[k][i] * right[k];
    right[i] /= normal[i][i];
  }
  return right;
}

function largest(values) {
  return values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
}

function norm(values) {
  return Math.hypot(...values);
}
