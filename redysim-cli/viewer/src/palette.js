// The colours of Okabe and Ito, which colour-blind people can tell apart, then some that they may not: as in the
// pictures of `redysim plot`.
const PALETTE = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#787878", "#78461e", "#969600", "#000000"];

export const GROUND = "#59636e";

/** When all colours are taken, they come again in dashes. */
export function dash(index) {
  return Math.floor(index / PALETTE.length) % 2 ? [7, 3] : [];
}

/** The colour of the joint of this number, and of the link that it carries. */
export function colour(index) {
  return PALETTE[index % PALETTE.length];
}
