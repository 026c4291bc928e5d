// Every recorded frame of every ball of the runs that are shown, one row each.

const kRows = 2e6;

export function csvOf(motions) {
  const axes = motions[0].scene.dimension === 2 ? ["x", "y"] : ["x", "y", "z"];
  const spun = motions.some((motion) => motion.spins);
  const heads = ["engine", "time_s", "ball", ...axes.map((a) => `${a}_m`), ...axes.map((a) => `v${a}_mps`),
    ...(spun ? ["wx_radps", "wy_radps", "wz_radps"] : [])];
  const rows = [heads.join(",")];
  for (const motion of motions) {
    for (let k = 0; k < motion.frames && rows.length < kRows; k += 1) {
      for (let i = 0; i < motion.balls; i += 1) {
        const at = 3 * (k * motion.balls + i);
        const numbers = [motion.times[k], i, ...axes.map((_, c) => motion.positions[at + c]),
          ...axes.map((_, c) => motion.velocities[at + c])];
        if (spun) numbers.push(...[0, 1, 2].map((c) => (motion.spins ? motion.spins[at + c] : 0)));
        rows.push(`${motion.about.label},${numbers.join(",")}`);
      }
    }
  }
  return `${rows.join("\n")}\n`;
}
