// Carom's own quadtree (octree in space) of the balls at one moment, as src/carom/broad_phase/tree.h builds and searches
// it: a cell with more than sixteen balls is cut, a ball goes down to the cell that its centre is in but stays where the
// cells below are narrower than itself, and what a search looks at is the box around all balls of a cell and below.

const kFewBalls = 16;
const kMostCuts = 64;

const sameFor = (dimension, value) => new Array(dimension).fill(value);
const emptyBox = (dimension) => ({ low: sameFor(dimension, Infinity), high: sameFor(dimension, -Infinity) });

function include(box, { low, high }) {
  for (let c = 0; c < low.length; c += 1) {
    box.low[c] = Math.min(box.low[c], low[c]);
    box.high[c] = Math.max(box.high[c], high[c]);
  }
}

const touch = (a, b) => a.low.every((x, c) => x <= b.high[c] && b.low[c] <= a.high[c]);

function boxAround(balls, dimension) {
  const box = emptyBox(dimension);
  balls.forEach((ball) => include(box, ball));
  return box;
}

function rootAround(balls, dimension) {
  const box = emptyBox(dimension);
  balls.forEach(({ at }) => include(box, { low: at, high: at }));
  return { centre: box.low.map((x, c) => 0.5 * (x + box.high[c])), half: 0.5 * Math.max(...box.high.map((x, c) => x - box.low[c])), depth: 0 };
}

const childOf = (cell, index) => ({
  centre: cell.centre.map((x, c) => x + (index >> c & 1 ? 0.5 : -0.5) * cell.half), half: 0.5 * cell.half, depth: cell.depth + 1 });

const indexIn = (cell, at) => at.reduce((index, x, c) => (x >= cell.centre[c] ? index | 1 << c : index), 0);

/** Those balls of a cell that stay in it, and those of each child; where all are in one child the cell becomes that one. */
function cut(balls, cell, dimension) {
  while (balls.length > kFewBalls && cell.depth < kMostCuts) {
    const own = [];
    const below = Array.from({ length: 1 << dimension }, () => []);
    for (const ball of balls) (2 * ball.radius > cell.half ? own : below[indexIn(cell, ball.at)]).push(ball);
    const only = below.findIndex((part) => part.length === balls.length);
    if (only < 0) return { cell, own, below };
    cell = childOf(cell, only);
  }
  return { cell, own: balls, below: [] };
}

/** Adds the node of these balls and those below it, each before them; `skip` leads past these. */
function grow(nodes, balls, around, dimension) {
  const { cell, own, below } = cut(balls, around, dimension);
  const node = { cell, own, ownBox: boxAround(own, dimension), box: boxAround(own, dimension), skip: 0 };
  nodes.push(node);
  below.forEach((part, index) => {
    if (part.length > 0) include(node.box, grow(nodes, part, childOf(cell, index), dimension).box);
  });
  node.skip = nodes.length;
  return node;
}

/** How many pairs are looked at: those of a node, and those of two nodes whose boxes touch. */
function countTests(nodes) {
  let tests = 0;
  nodes.forEach(({ own, ownBox }, first) => {
    tests += own.length * (own.length - 1) / 2;
    for (let n = first + 1; n < nodes.length;) {
      if (!touch(ownBox, nodes[n].box)) { n = nodes[n].skip; continue; }
      for (const ball of own) if (touch(ball, nodes[n].box)) tests += nodes[n].own.length;
      n += 1;
    }
  });
  return tests;
}

/** @returns cells (centre, half, depth; the root first) and tests, the pairs that are looked at, each once */
export function divide(state, { masses, radii }, dimension) {
  const balls = [];
  for (let i = 0; i < radii.length; i += 1) {
    if (Number.isNaN(masses[i])) continue; // it is not there
    const at = Array.from(state.x.subarray(3 * i, 3 * i + dimension));
    balls.push({ at, radius: radii[i], low: at.map((x) => x - radii[i]), high: at.map((x) => x + radii[i]) });
  }
  if (balls.length === 0) return { cells: [], tests: 0 };
  const nodes = [];
  grow(nodes, balls, rootAround(balls, dimension), dimension);
  return { cells: nodes.map(({ cell }) => ({ ...cell, centre: [...cell.centre, 0].slice(0, 3) })), tests: countTests(nodes) };
}
