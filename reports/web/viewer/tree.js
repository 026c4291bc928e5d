// The quadtree (octree in space) of the balls at one moment: a cell that more than four balls reach into is divided, and
// a ball is in every cell that it reaches into. Only balls of one undivided cell can touch.

const kFullAt = 4;
const kDeepest = 9;

function cellAround(state, radii, dimension, box) {
  const low = box ? [...box.min] : [Infinity, Infinity, Infinity];
  const high = box ? [...box.max] : [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < radii.length; i += 1) {
    for (let c = 0; c < 3; c += 1) {
      low[c] = Math.min(low[c], state.x[3 * i + c] - radii[i]);
      high[c] = Math.max(high[c], state.x[3 * i + c] + radii[i]);
    }
  }
  const half = 0.5 * Math.max(...[0, 1, 2].slice(0, dimension).map((c) => high[c] - low[c]));
  return { centre: low.map((x, c) => 0.5 * (x + high[c])), half, depth: 0 };
}

function childrenOf(cell, dimension) {
  const half = 0.5 * cell.half;
  return Array.from({ length: 1 << dimension }, (_, index) => ({
    centre: cell.centre.map((x, c) => (c < dimension ? x + (index >> c & 1 ? half : -half) : x)), half, depth: cell.depth + 1 }));
}

function reaches(cell, state, i, radius, dimension) {
  for (let c = 0; c < dimension; c += 1) {
    if (Math.abs(state.x[3 * i + c] - cell.centre[c]) > cell.half + radius) return false;
  }
  return true;
}

/**
 * @param box  of the scene, where it has one; the root holds it
 * @returns cells (centre, half, depth; the root first), tests (pairs that share a cell, each once) and bruteForce (all)
 */
export function divide(state, radii, dimension, box = null) {
  const count = radii.length;
  const cells = [];
  const pairs = new Set();
  const visit = (cell, balls) => {
    cells.push(cell);
    // Cells smaller than the balls in them would only repeat them.
    const smallest = balls.reduce((least, i) => Math.min(least, radii[i]), Infinity);
    if (balls.length > kFullAt && cell.depth < kDeepest && cell.half > 2 * smallest) {
      for (const child of childrenOf(cell, dimension)) {
        visit(child, balls.filter((i) => reaches(child, state, i, radii[i], dimension)));
      }
      return;
    }
    for (let a = 0; a < balls.length; a += 1) {
      for (let b = 0; b < a; b += 1) pairs.add(balls[a] * count + balls[b]);
    }
  };
  if (count > 0) visit(cellAround(state, radii, dimension, box), [...radii.keys()]);
  return { cells, tests: pairs.size, bruteForce: count * (count - 1) / 2 };
}
